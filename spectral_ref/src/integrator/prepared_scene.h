// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/camera.h"
#include "geometry/embree_scene.h"
#include "lights/light_table.h"
#include "materials/material_table.h"
#include "metamer/spectral_ref/scene.h"
#include "wavelengths/lanes.h"

namespace metamer::spectral_ref {

/// A scene made ready to trace: flat tables, built once, read by all threads.
struct PreparedScene {
  explicit PreparedScene(const Scene& description)
      : scene(description),
        shapes(description),
        spectra(description),
        materials(description),
        lights(description, shapes),
        camera(description.camera, description.film) {}

  const Scene& scene;
  EmbreeScene shapes;
  SpectrumTables spectra;
  MaterialTable materials;
  LightTable lights;
  Camera camera;
};

}  // namespace metamer::spectral_ref
