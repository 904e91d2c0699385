// SPDX-License-Identifier: Apache-2.0
// A C door to the engine and the map, so that one Python process can time and judge them beside their peers.
#include <chrono>
#include <cstring>
#include <memory>
#include <vector>

#include "metamer/sip/error_protocol.h"
#include "metamer/sip/homogeneous_map.h"
#include "metamer/sip/recipe.h"
#include "metamer/sip/smoothest_spectrum.h"
#include "metamer/spectral/colorimetry.h"
#include "metamer/spectral/data_library.h"

using namespace metamer;

namespace {

struct Session {
  std::unique_ptr<sip::SpectralTransform> exact;
  std::unique_ptr<sip::ErrorProtocol> protocol;
  sip::HomogeneousMap map;
  double buildSeconds = 0;
};

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

/// Transform from one light of data/ to another in ACEScg, its map and its probes. Free with metamerClose.
/// @param scene  "natural" or "smooth"
extern "C" void* metamerOpen(const char* input, const char* output, const char* scene) {
  const auto library = spectral::DataLibrary::openDefault();
  sip::Recipe recipe;
  recipe.input.illuminant = input;
  recipe.output.illuminant = output;
  recipe.scene.kind = sip::sceneKindFromName(scene);
  const sip::TransformSpec spec = sip::resolve(recipe, library);
  auto session = std::make_unique<Session>();
  session->exact = std::make_unique<sip::SpectralTransform>(spec);
  const auto start = std::chrono::steady_clock::now();
  session->map = sip::buildHomogeneousMap(*session->exact);
  session->buildSeconds = secondsSince(start);
  session->protocol = std::make_unique<sip::ErrorProtocol>(spec, library.reflectances("colorchecker").samples);
  return session.release();
}

extern "C" void metamerClose(void* handle) {
  delete static_cast<Session*>(handle);
}

extern "C" double metamerBuildSeconds(void* handle) {
  return static_cast<Session*>(handle)->buildSeconds;
}

extern "C" void metamerMap(void* handle, const float* source, float* destination, std::size_t pixels) {
  static_cast<Session*>(handle)->map.apply({source, 4 * pixels}, {destination, 4 * pixels});
}

/// Doubles in and out, three a colour. `converged`: the 401-band engine.
extern "C" void metamerExact(void* handle, const double* rgb, double* result, std::size_t count, int converged) {
  const auto* session = static_cast<Session*>(handle);
  const auto& transform = converged != 0 ? session->protocol->converged() : *session->exact;
  std::vector<Eigen::Vector3d> colours(count);
  for (std::size_t i = 0; i < count; ++i) {
    colours[i] = Eigen::Map<const Eigen::Vector3d>(rgb + 3 * i);
  }
  transform.apply(colours);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Map<Eigen::Vector3d>(result + 3 * i) = colours[i];
  }
}

/// Probes of the protocol at stop 0, three doubles a probe; `rgb` null: only their number.
extern "C" std::size_t metamerProbes(void* handle, double* rgb) {
  const auto& probes = static_cast<Session*>(handle)->protocol->probes();
  for (std::size_t i = 0; rgb != nullptr && i < probes.size(); ++i) {
    Eigen::Map<Eigen::Vector3d>(rgb + 3 * i) = probes[i].rgb;
  }
  return probes.size();
}

/// CIEDE2000 of pairs of ACEScg colours relative to the working white.
extern "C" void metamerDeltaE(void* handle, const double* a, const double* b, double* deltaE, std::size_t count) {
  const auto& space = static_cast<Session*>(handle)->exact->space();
  const Eigen::Matrix3d xyzFromRgb = space.xyzFromRgb();
  const Eigen::Vector3d white = space.whiteXyz();
  for (std::size_t i = 0; i < count; ++i) {
    deltaE[i] = spectral::deltaE2000(spectral::lab(xyzFromRgb * Eigen::Map<const Eigen::Vector3d>(a + 3 * i), white),
                                     spectral::lab(xyzFromRgb * Eigen::Map<const Eigen::Vector3d>(b + 3 * i), white));
  }
}

/// Solves `count` tristimuli (XYZ relative to the light's white Y = 1) under a light of data/; seconds of each.
extern "C" void metamerTimeSolves(const char* light, int bands, int upperBound, const double* xyz, std::size_t count,
                                  double* seconds) {
  const auto library = spectral::DataLibrary::openDefault();
  Eigen::Matrix3Xd weights =
      sip::bandWeights(library.illuminant(light).onDomain(), library.observer("CIE 1931 2").onDomain(), bands);
  weights /= weights.row(1).sum();
  const sip::SmoothestSpectrumSolver solver(weights, upperBound != 0 ? sip::SmoothestSpectrumSolver::UpperBound::One
                                                                     : sip::SmoothestSpectrumSolver::UpperBound::None);
  for (std::size_t i = 0; i < count; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const auto solution = solver.solve(Eigen::Map<const Eigen::Vector3d>(xyz + 3 * i));
    seconds[i] = solution ? secondsSince(start) : -1.0;
  }
}

extern "C" void metamerCopy(const float* source, float* destination, std::size_t pixels) {
  std::memcpy(destination, source, 16 * pixels);
}
