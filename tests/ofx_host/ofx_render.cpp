// SPDX-License-Identifier: Apache-2.0
// Renders a picture with an effect of a bundle in the photo host.
//
//   ofx_render FOLDER list
//   ofx_render FOLDER PLUGIN WIDTH HEIGHT IN OUT [--threads N] [--tile N] [--depth D] [--set NAME=VALUE]... [--save
//   FILE]
//
// IN and OUT are bare floats, RGBA, bottom row first.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

#include "photo_host.h"

namespace {

using photo_host::Picture;
using photo_host::Window;

Picture readPicture(const std::string& file, int width, int height) {
  Picture picture{0, 0, width, height, {}};
  picture.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::ifstream stream(file, std::ios::binary);
  const auto bytes = static_cast<std::streamsize>(picture.rgba.size() * sizeof(float));
  if (!stream.read(reinterpret_cast<char*>(picture.rgba.data()), bytes)) {
    throw std::runtime_error(file + " is too short");
  }
  return picture;
}

void writePicture(const std::string& file, const Picture& picture) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(picture.rgba.data()),
               static_cast<std::streamsize>(picture.rgba.size() * sizeof(float)));
  if (!stream.flush()) {
    throw std::runtime_error(file + " cannot be written");
  }
}

std::vector<Window> tiles(const Picture& picture, int side) {
  std::vector<Window> windows;
  for (int y = 0; y < picture.height; y += side) {
    for (int x = 0; x < picture.width; x += side) {
      windows.push_back({x, y, std::min(x + side, picture.width), std::min(y + side, picture.height)});
    }
  }
  return windows;
}

struct Options {
  int threads = 1;
  int tile = 1 << 20;
  photo_host::ClipKind kind;
  std::vector<std::pair<std::string, std::string>> settings;
  std::string save;
  std::map<std::string, std::string> loaded;
};

/// NAME=VALUE a line, as --save writes it.
std::map<std::string, std::string> readProject(const std::string& file) {
  std::map<std::string, std::string> project;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const std::size_t equals = line.find('=');
    project[line.substr(0, equals)] = line.substr(equals + 1);
  }
  return project;
}

Options parse(const std::vector<std::string>& words, std::size_t first) {
  Options options;
  for (std::size_t i = first; i + 1 < words.size(); i += 2) {
    const std::string& value = words[i + 1];
    if (words[i] == "--threads") {
      options.threads = std::stoi(value);
    } else if (words[i] == "--tile") {
      options.tile = std::stoi(value);
    } else if (words[i] == "--depth") {
      options.kind.depth = "OfxBitDepth" + value;
    } else if (words[i] == "--save") {
      options.save = value;
    } else if (words[i] == "--load") {
      options.loaded = readProject(value);
    } else if (words[i] == "--set") {
      const std::size_t equals = value.find('=');
      options.settings.emplace_back(value.substr(0, equals), value.substr(equals + 1));
    } else {
      throw std::runtime_error("unknown option " + words[i]);
    }
  }
  return options;
}

int run(const std::vector<std::string>& words) {
  if (words.size() == 2 && words[1] == "list") {
    photo_host::Host host(words[0], 1);
    for (const std::string& plugin : host.plugins()) {
      std::cout << plugin << "\n";
    }
    return 0;
  }
  if (words.size() < 6) {
    throw std::runtime_error("usage: ofx_render FOLDER PLUGIN WIDTH HEIGHT IN OUT [options]");
  }
  const Options options = parse(words, 6);
  photo_host::Host host(words[0], options.threads);
  const auto effect = host.create(words[1], "OfxImageEffectContextFilter", options.kind, options.loaded);
  for (const auto& [name, value] : options.settings) {
    effect->set(name, value);
  }
  const Picture picture = readPicture(words[4], std::stoi(words[2]), std::stoi(words[3]));
  effect->setSource(picture);
  const Picture result = effect->render(tiles(picture, options.tile));
  if (!effect->message().empty()) {
    std::cerr << effect->message() << "\n";
  }
  if (!options.save.empty()) {
    std::ofstream stream(options.save);
    for (const auto& [name, value] : effect->save()) {
      stream << name << "=" << value << "\n";
    }
  }
  writePicture(words[5], result);
  return effect->lastStatus() == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** arguments) {
  try {
    return run({arguments + 1, arguments + count});
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
