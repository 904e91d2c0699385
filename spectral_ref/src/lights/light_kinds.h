// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "lights/environment_emitter.h"
#include "lights/mesh_emitter.h"
#include "lights/point_emitter.h"
#include "lights/rectangle_emitter.h"
#include "lights/sphere_emitter.h"
#include "lights/spot_emitter.h"

namespace metamer::spectral_ref {

/// All kinds of emitter. Shapes come first, in the order in which EmbreeScene numbers those that emit. A kind has
///
///     static void collect(scene, shapes, add)       calls add(emitter, glow, number of elements, EmbreeScene's number
///                                                   or kNone) for each of its emitters in a scene
///     AreaPoint areaPoint(element, u, v)            a point of an element, evenly over its area ...
///     LightSample located(element, u, v, from)      ... or, of other kinds, one with the density that it has once the
///                                                   element is chosen; pdf 0 where it is not seen
///     std::uint32_t elementOf(hit)                  the element that a ray hit ...
///     float pdf(hit, from, direction)               ... and the density with which located() finds it
///     double powerExtent(element)                   power over radiance or intensity
///     LightBounds bounds(element)                   where it lies and shines, for a radiance or intensity of 1
using EmitterKind =
    std::variant<RectangleEmitter, SphereEmitter, MeshEmitter, EnvironmentEmitter, PointEmitter, SpotEmitter>;

}  // namespace metamer::spectral_ref
