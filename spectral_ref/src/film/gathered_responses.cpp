// SPDX-License-Identifier: Apache-2.0
#include "film/gathered_responses.h"

namespace metamer::spectral_ref {

void GatheredResponses::addTo(FilmSums& film, std::size_t pixel) const {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t odd = m_sums[1][c] + m_sums[3][c];
    film.addUnits(pixel, Film::kColour + c, m_sums[0][c] + m_sums[2][c] + odd);
    film.addUnits(pixel, Film::kHalf + c, odd);
  }
  for (std::size_t replicate = 0; replicate < kReplicates; ++replicate) {
    film.addUnits(pixel, Film::kLuminance + replicate, m_sums[replicate][3]);
  }
}

}  // namespace metamer::spectral_ref
