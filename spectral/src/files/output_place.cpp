// SPDX-License-Identifier: Apache-2.0
#include "files/output_place.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>

#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"
#include "metamer/spectral/platform.h"

#if !defined(_WIN32)
#include <sys/stat.h>
#include <unistd.h>
#endif

namespace metamer::spectral {
namespace {

namespace fs = std::filesystem;
using Type = fs::file_type;

constexpr int kMostLinks = 40;

/// Of /dev/stdout, /dev/stderr, /dev/fd/N and /proc/self/fd/N: opened by name they would start at their beginning.
std::optional<int> descriptorOf(const fs::path& path) {
  const std::string name = utf8(path.lexically_normal());
  if (name == "/dev/stdout") {
    return 1;
  }
  if (name == "/dev/stderr") {
    return 2;
  }
  for (const std::string folder : {"/dev/fd/", "/proc/self/fd/"}) {
    int number = 0;
    const char* end = name.data() + name.size();
    if (name.rfind(folder, 0) == 0) {
      const auto parsed = std::from_chars(name.data() + folder.size(), end, number);
      if (parsed.ec == std::errc() && parsed.ptr == end && number >= 0) {
        return number;
      }
    }
  }
  return std::nullopt;
}

[[noreturn]] void refuse(const fs::path& target, const std::string& remedy) {
  throw InputError(utf8(target), "output", "", remedy);
}

fs::path behindLinks(const fs::path& target) {
  fs::path path = target;
  std::error_code none;
  for (int links = 0; fs::is_symlink(path, none); ++links) {
    if (links == kMostLinks) {
      refuse(target, "is a link that leads in a circle; mend it, or name a file");
    }
    path = path.parent_path() / fs::read_symlink(path, none);
  }
  return path;
}

}  // namespace

OutputPlace outputPlace(const fs::path& target) {
#if !defined(_WIN32)
  if (descriptorOf(target)) {
    return {target, true};
  }
#endif
  const fs::path path = behindLinks(target);
  std::error_code none;
  const Type type = fs::status(path, none).type();
  if (path.filename().empty() || type == Type::directory) {
    refuse(target, "is a folder; name a file");
  }
  if (type == Type::block || type == Type::socket) {
    refuse(target, "is a disk or a socket; name a file");
  }
#if !defined(_WIN32)
  if (type == Type::not_found && path.lexically_normal().parent_path() == "/dev") {
    refuse(target, "is no device that is there; name a file elsewhere");
  }
  if (type != Type::not_found && access(path.c_str(), W_OK) != 0) {
    refuse(target, "cannot be written: " + std::string(std::strerror(errno)) + "; change its mode, or name another");
  }
#endif
  return {path, type == Type::character || type == Type::fifo};
}

std::FILE* openStream(const fs::path& path) {
#if !defined(_WIN32)
  if (const auto descriptor = descriptorOf(path)) {
    const int own = dup(*descriptor);
    return own < 0 ? nullptr : fdopen(own, "wb");
  }
#endif
  return openFile(path, "wb");
}

void keepOwnerAndMode(const fs::path& from, const fs::path& to) {
#if !defined(_WIN32)
  struct stat status = {};
  if (stat(from.c_str(), &status) != 0) {
    return;
  }
  // Only root may give a file away; whoever may not keeps it as a new one's owner.
  if (chown(to.c_str(), status.st_uid, status.st_gid) != 0) {
    errno = 0;
  }
  chmod(to.c_str(), status.st_mode & 07777U);
#endif
}

}  // namespace metamer::spectral
