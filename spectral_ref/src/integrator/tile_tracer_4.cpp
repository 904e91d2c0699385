// SPDX-License-Identifier: Apache-2.0
#include "integrator/tile_tracer_template.h"

namespace metamer::spectral_ref {

template std::unique_ptr<TileTracer> makeTileTracer<4>(const TracerContext&);

}  // namespace metamer::spectral_ref
