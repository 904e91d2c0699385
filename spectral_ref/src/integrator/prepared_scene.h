// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "geometry/camera.h"
#include "geometry/embree_scene.h"
#include "lights/brightness.h"
#include "lights/light_choice.h"
#include "lights/light_reach.h"
#include "lights/light_table.h"
#include "lights/light_tree.h"
#include "materials/material_table.h"
#include "metamer/spectral_ref/renderer.h"
#include "metamer/spectral_ref/scene.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// A scene made ready to trace: flat tables, built once, read by all threads.
struct PreparedScene {
  PreparedScene(const Scene& description, const RenderOptions& options)
      : scene(description),
        shapes(description),
        spectra(description),
        materials(description),
        lights(description, shapes),
        lightReach(lights, description),
        isChosenByPlace(options.lightRule == LightRule::Place && LightChoice::isWorthwhile(lights)),
        tree(isChosenByPlace || (options.restir != Restir::Off && !lights.empty())
                 ? std::make_unique<LightTree>(lights.bounds(description))
                 : nullptr),
        lightChoice(lights, isChosenByPlace ? tree.get() : nullptr),
        camera(description.camera, description.film),
        brightness(brightnessOf(lights.bounds(description), description.camera)) {}

  const Scene& scene;
  EmbreeScene shapes;
  SpectrumTables spectra;
  MaterialTable materials;
  LightTable lights;
  LightReach lightReach;
  bool isChosenByPlace;
  std::unique_ptr<const LightTree> tree;  ///< null where neither light choice nor resampling needs one
  LightChoice lightChoice;
  Camera camera;
  double brightness;  ///< about what surfaces send, Y
};

}  // namespace metamer::spectral_ref
