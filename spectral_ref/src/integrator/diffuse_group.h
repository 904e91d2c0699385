// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "geometry/ray_group.h"
#include "lights/rectangle_emitter.h"

// What diffuse surfaces do to the paths of a group, as far as it is the same at all wavelengths: in vector lanes, the
// ones that do not count included.
namespace metamer::spectral_ref {

/// A point on a light for each path, to be looked at from its surface.
struct LightsOfGroup {
  EachVec3 place;
  EachVec3 area;              ///< normal there, as long as the area that the point was drawn from
  EachRay<float> chance{};    ///< of having chosen that area
  EachRay<float> isShared{};  ///< 1: the next direction may find the point as well; 0: it does not
  EachRay<float> weight{};  ///< found: what reflectance times radiance is multiplied with, the balance heuristic in it
};

/// Those of a group's rays that come to the front of what they hit. Of rays that hit nothing, any.
RayMask onFront(const RayGroup& rays, const HitGroup& hits);

/// Draws points of the only light there is: all of `lights` but `isShared` and the weights.
/// @param u, v  0 ... 1
void pointsOn(const RectangleEmitter& rectangle, const EachRay<float>& u, const EachRay<float>& v,
              LightsOfGroup& lights);

/// Finds the weights of points, 0 where one is not seen, and the rays to them.
/// @param towards  not of unit length: they end a little short of the points
void lookAtLights(const HitGroup& hits, LightsOfGroup& lights, RayGroup& towards);

/// Draws directions with density cos / pi.
/// @param u, v  0 ... 1
/// @param others  paths whose rays stay as they are
/// @param next    the rays on of those in `paths`; of those in neither, anything
/// @param pdf     of the directions
void scatterDiffusely(const HitGroup& hits, const EachRay<float>& u, const EachRay<float>& v, RayMask paths,
                      RayMask others, RayGroup& next, EachRay<float>& pdf);

}  // namespace metamer::spectral_ref
