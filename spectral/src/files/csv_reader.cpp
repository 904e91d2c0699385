// SPDX-License-Identifier: Apache-2.0
#include "files/csv_reader.h"

#include <utility>

#include "files/column_choice.h"
#include "metamer/spectral/spectral_files.h"
#include "tables/layouts.h"
#include "tables/text_encoding.h"

namespace metamer::spectral {

std::vector<Spectrum> readCsvOfScale(std::string_view text, const std::string& where, SpectralQuantity quantity,
                                     StatedScale scale) {
  const std::string utf8 = decodedTable(text, where);
  std::vector<Spectrum> spectra;
  for (TableCurves& curves : readTable(tableText(utf8, where))) {
    const StatedScale stated = scale == StatedScale::NotStated ? curves.scale : scale;
    for (Spectrum& spectrum : spectraFromRows(std::move(curves.rows), quantity, stated)) {
      spectra.push_back(std::move(spectrum));
    }
  }
  return spectra;
}

Spectrum readCsvColumn(std::string_view text, const std::string& where, SpectralQuantity quantity,
                       const std::string& column) {
  const std::string utf8 = decodedTable(text, where);
  std::vector<TableCurves> tables = readTable(tableText(utf8, where));
  std::vector<std::string> names;
  for (const TableCurves& curves : tables) {
    names.insert(names.end(), curves.rows.names.begin(), curves.rows.names.end());
  }
  std::size_t index = columnIndex(column, names, where);
  auto table = tables.begin();
  while (index >= table->rows.names.size()) {
    index -= table->rows.names.size();
    ++table;
  }
  return spectraFromRows(columnsOf(std::move(table->rows), {index}), quantity, table->scale).front();
}

std::vector<Spectrum> readCsv(const std::string& text, const std::string& where, SpectralQuantity quantity) {
  return readCsvOfScale(text, where, quantity, StatedScale::NotStated);
}

}  // namespace metamer::spectral
