// SPDX-License-Identifier: Apache-2.0
// Renders the test picture as a file of jobs says, in the bare host: the same on every system that the bundle is for.
//
//     metamer_ofx_frames JOBS
//
// A line a job, of cells between tabs: the effect's number, the picture to write (bare 32-bit floats, RGBA), and
// parameters as NAME=VALUE. UTF-8, so that only the name of JOBS itself passes through a command line.
#include <fstream>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "frame.h"

namespace {

using namespace bare_host;

constexpr OfxRectI kBounds = {0, 0, 160, 90};

std::vector<std::string> cellsOf(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, '\t');) {
    cells.push_back(cell);
  }
  return cells;
}

void set(Instance& effect, const std::string& setting) {
  const std::size_t equals = setting.find('=');
  const std::string name = setting.substr(0, equals);
  const std::string value = setting.substr(equals + 1);
  const std::string& type = effect.effect().parameters.at(name)->type;
  if (type == kOfxParamTypeDouble) {
    effect.set(name, std::stod(value));
  } else if (type == kOfxParamTypeBoolean) {
    effect.set(name, std::stoi(value));
  } else {
    effect.set(name, value);
  }
}

void render(const Host& host, const std::vector<std::string>& job) {
  const auto effect = host.create(std::stoi(job.at(0)));
  for (std::size_t i = 2; i < job.size(); ++i) {
    set(*effect, job[i]);
  }
  Frame source{{.bounds = kBounds}};
  Frame output{{.bounds = kBounds}};
  source.fill(testPixel);
  effect->connect("Source", source.image());
  effect->connect("Output", output.image());
  if (effect->render(kBounds) != kOfxStatOK || !effect->message().empty()) {
    throw std::runtime_error(job[1] + ": " + effect->message());
  }
  std::ofstream stream(pathOf(job[1]), std::ios::binary);
  for (int y = kBounds.y1; y < kBounds.y2; ++y) {
    for (int x = kBounds.x1; x < kBounds.x2; ++x) {
      stream << output.bytes(x, y);
    }
  }
  if (!stream.flush()) {
    throw std::runtime_error(job[1] + " cannot be written");
  }
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count != 2) {
      throw std::runtime_error("usage: metamer_ofx_frames JOBS");
    }
    const Host host(builtLibrary(), {.threads = 2});
    std::ifstream jobs(arguments[1]);
    int done = 0;
    for (std::string line; std::getline(jobs, line); ++done) {
      render(host, cellsOf(line));
    }
    std::cout << done << " pictures\n";
    return done > 0 ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
