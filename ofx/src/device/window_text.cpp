// SPDX-License-Identifier: Apache-2.0
#include "device/window_text.h"

#include "pixels/signal_table.h"

namespace metamer::ofx {
namespace {

#include "device/text/signal_table.prelude"

static_assert(METAMER_LEAST_SIGNAL == SignalTable::kLeastSignal);
static_assert(METAMER_CELLS_PER_SIGNAL == SignalTable::kCellsPerSignal);
static_assert(METAMER_SIGNAL_CELLS == SignalTable::kSignalCells);
static_assert(METAMER_REST_BITS == SignalTable::kRestBits);
static_assert(METAMER_FIRST_CELL == SignalTable::kFirstCell);
static_assert(METAMER_CELLS_A_SIGN == SignalTable::kCellsASign);

}  // namespace
}  // namespace metamer::ofx
