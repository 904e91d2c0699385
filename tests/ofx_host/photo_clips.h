// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "host_support.h"
#include "photo_host.h"

namespace photo_host {

/// Pixels of one clip in its own depth and components.
class Store {
 public:
  Store() = default;
  Store(const Picture& picture, const ClipKind& kind);

  Picture picture() const;
  bool isEmpty() const { return m_bytes.empty(); }
  OfxRectI bounds() const;
  int rowBytes() const;
  void* data() { return m_bytes.data(); }

 private:
  int m_x = 0;
  int m_y = 0;
  int m_width = 0;
  int m_height = 0;
  ClipKind m_kind;
  std::vector<unsigned char> m_bytes;
};

/// A clip that always shows the same stored picture.
class Clip final : public OFX::Host::ImageEffect::ClipInstance {
 public:
  Clip(OFX::Host::ImageEffect::Instance* effect, OFX::Host::ImageEffect::ClipDescriptor& descriptor, ClipKind kind);

  void show(const Picture& picture);
  Picture shown() const { return m_store.picture(); }
  const ClipKind& kind() const { return m_kind; }

  const std::string& getUnmappedBitDepth() const override { return m_kind.depth; }
  const std::string& getUnmappedComponents() const override { return m_kind.components; }
  const std::string& getPremult() const override { return m_kind.premultiplication; }
  double getAspectRatio() const override { return 1; }
  double getFrameRate() const override { return 24; }
  void getFrameRange(double& start, double& end) const override;
  const std::string& getFieldOrder() const override;
  bool getConnected() const override { return isOutput() || !m_store.isEmpty(); }
  double getUnmappedFrameRate() const override { return 24; }
  void getUnmappedFrameRange(double& start, double& end) const override { getFrameRange(start, end); }
  bool getContinuousSamples() const override { return false; }
  OfxRectD getRegionOfDefinition(OfxTime time) const override;
  OFX::Host::ImageEffect::Image* getImage(OfxTime time, const OfxRectD* bounds) override;

 private:
  ClipKind m_kind;
  Store m_store;
};

}  // namespace photo_host
