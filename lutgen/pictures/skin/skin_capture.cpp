// SPDX-License-Identifier: Apache-2.0
#include "skin/skin_capture.h"

#include <algorithm>
#include <thread>

#include "stage/fixture_options.h"

namespace metamer::lutgen {

SkinCapture SkinCapture::orElse(const SkinCapture& other) const {
  return {illuminant.empty() ? other.illuminant : illuminant, observer.empty() ? other.observer : observer};
}

void addSkinCapture(CLI::App& command, SkinCapture& capture, const std::string& without) {
  command.add_option("--illuminant", capture.illuminant, "Light of the capture: NAME or FILE; left out: " + without);
  command.add_option("--observer", capture.observer,
                     "Observer or camera of the capture: NAME or FILE; left out: " + without);
}

skin::SkinView skinView(const SkinCapture& capture, const spectral::RgbSpace& space,
                        const spectral::DataLibrary& library) {
  const spectral::Spectrum light = library.illuminant(capture.illuminant);
  spectral::Observer observer = library.observer(capture.observer);
  if (!observer.xyzFromResponse) {
    observer.xyzFromResponse = xyzFromResponseUnder(light, observer, library);
  }
  return {light, observer, space};
}

int skinThreads(int threads) {
  const auto all = static_cast<int>(std::thread::hardware_concurrency());
  return std::clamp(threads > 0 ? threads : all, 1, 256);
}

}  // namespace metamer::lutgen
