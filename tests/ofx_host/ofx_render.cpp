// SPDX-License-Identifier: Apache-2.0
// Renders a picture with an effect of a bundle in the photo host, from the command line.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <stdexcept>
#include <string>

#include "photo_host.h"

namespace {

constexpr const char* kHelp =
    "usage: metamer_ofx_render FOLDER list\n"
    "       metamer_ofx_render FOLDER PLUGIN WIDTH HEIGHT IN OUT [options]\n\n"
    "FOLDER holds the bundles; PLUGIN is an effect as list prints it. IN and OUT are bare 32-bit floats, RGBA, bottom\n"
    "row first.\n\n"
    "  --set NAME=VALUE  a parameter: a number, 0 or 1, a menu's entry, a text; may be repeated\n"
    "  --save FILE       all parameters afterwards, as the host keeps them in a project\n"
    "  --load FILE       parameters that --save wrote, before the effect is created\n"
    "  --threads N       of the host's multi-thread suite\n"
    "  --tile N          renders tiles of N x N pixels\n"
    "  --depth D         Float, Half, Short or Byte: what the host hands over\n";

using photo_host::Picture;
using photo_host::Window;

Picture readPicture(const std::string& file, int width, int height) {
  Picture picture{0, 0, width, height, {}};
  picture.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::ifstream stream(file, std::ios::binary);
  const auto bytes = static_cast<std::streamsize>(picture.rgba.size() * sizeof(float));
  if (!stream.read(reinterpret_cast<char*>(picture.rgba.data()), bytes)) {
    throw std::runtime_error(file + " cannot be read, or holds less than " + std::to_string(width) + " x " +
                             std::to_string(height) + " pixels of four floats");
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
  if (!stream) {
    throw std::runtime_error(file + " cannot be read");
  }
  for (std::string line; std::getline(stream, line);) {
    const std::size_t equals = line.find('=');
    project[line.substr(0, equals)] = line.substr(equals + 1);
  }
  return project;
}

Options parse(const std::vector<std::string>& words, std::size_t first) {
  Options options;
  for (std::size_t i = first; i < words.size(); i += 2) {
    if (i + 1 == words.size()) {
      throw std::runtime_error(words[i] + " wants a value; see --help");
    }
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
      if (equals == std::string::npos) {
        throw std::runtime_error("--set takes NAME=VALUE, not '" + value + "'");
      }
      options.settings.emplace_back(value.substr(0, equals), value.substr(equals + 1));
    } else {
      throw std::runtime_error("unknown option " + words[i] + "; see --help");
    }
  }
  return options;
}

int run(const std::vector<std::string>& words) {
  if (words == std::vector<std::string>{"--help"} || words == std::vector<std::string>{"-h"}) {
    std::cout << kHelp;
    return 0;
  }
  if (words.size() == 2 && words[1] == "list") {
    photo_host::Host host(words[0], 1);
    const std::vector<std::string> plugins = host.plugins();
    if (plugins.empty()) {
      throw std::runtime_error("no effect is found in " + words[0] + "; it must be the folder that holds *.ofx.bundle");
    }
    for (const std::string& plugin : plugins) {
      std::cout << plugin << "\n";
    }
    return 0;
  }
  if (words.size() < 6) {
    std::cerr << kHelp;
    return 2;
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
    if (!stream.flush()) {
      throw std::runtime_error(options.save + " cannot be written");
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
