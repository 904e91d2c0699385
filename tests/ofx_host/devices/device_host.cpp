// SPDX-License-Identifier: Apache-2.0
#include "device_host.h"

#include <algorithm>
#include <cstdlib>

namespace bare_host {
namespace {

constexpr std::size_t kGuardBytes = 64;
constexpr unsigned char kGuard = 0x5A;

}  // namespace

DeviceFrame::DeviceFrame(const DeviceHost& host, const Frame& frame, std::size_t begin)
    : m_host(host), m_frame(frame), m_begin(begin) {
  const Image image = frame.image();
  const std::ptrdiff_t below = image.bounds.y2 - image.bounds.y1 - 1;
  auto* const first = static_cast<unsigned char*>(image.data);
  if (first == nullptr) {
    return;
  }
  m_low = image.rowBytes < 0 ? first + below * image.rowBytes : first;
  const std::size_t rows = static_cast<std::size_t>(below) * static_cast<std::size_t>(std::abs(image.rowBytes));
  m_bytes = rows + static_cast<std::size_t>(std::abs(image.rowBytes) - frame.shape().padding);
  std::vector<unsigned char> content(begin + m_bytes + kGuardBytes, kGuard);
  std::copy_n(m_low, m_bytes, content.begin() + static_cast<std::ptrdiff_t>(begin));
  m_whole = host.buffer(content.size(), content.data());
  m_buffer = begin == 0 ? m_whole : host.part(m_whole, begin, m_bytes + kGuardBytes);
}

DeviceFrame::~DeviceFrame() {
  if (m_whole != nullptr) {
    m_host.release(m_whole);
  }
  if (m_buffer != m_whole) {
    m_host.releasePart(m_buffer);
  }
}

Image DeviceFrame::image(const std::string& premultiplication) const {
  Image image = m_frame.image(premultiplication);
  const auto* const first = static_cast<const unsigned char*>(image.data);
  image.data = m_buffer == nullptr ? nullptr : m_host.imageData(m_buffer, static_cast<std::size_t>(first - m_low));
  return image;
}

Image DeviceFrame::turnedImage() const {
  Image image = m_frame.image();
  const std::ptrdiff_t below = image.bounds.y2 - image.bounds.y1 - 1;
  const unsigned char* const last = static_cast<const unsigned char*>(image.data) + below * image.rowBytes;
  image.rowBytes = -image.rowBytes;
  image.data = m_host.imageData(m_buffer, static_cast<std::size_t>(last - m_low));
  return image;
}

bool DeviceFrame::bring(int queue) const {
  if (m_whole == nullptr) {
    return true;
  }
  std::vector<unsigned char> content(m_begin + m_bytes + kGuardBytes);
  m_host.read(m_whole, content.size(), content.data(), queue);
  const auto rows = content.begin() + static_cast<std::ptrdiff_t>(m_begin);
  std::copy_n(rows, m_bytes, m_low);
  const auto isGuard = [](unsigned char byte) { return byte == kGuard; };
  return std::all_of(content.begin(), rows, isGuard) &&
         std::all_of(rows + static_cast<std::ptrdiff_t>(m_bytes), content.end(), isGuard);
}

}  // namespace bare_host
