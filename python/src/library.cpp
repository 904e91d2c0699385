// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>

#include "bindings.h"
#include "metamer/spectral/data_library.h"
#include "metamer/spectral/platform.h"

using namespace nanobind::literals;

namespace metamer::python {
namespace {

using spectral::DataLibrary;

/// Beside the module in a wheel, in share/ of an install tree.
DataLibrary openUsual() {
  static const char kAnchor = 0;
  if (!spectral::environmentValue("METAMER_DATA")) {
    const std::filesystem::path own = spectral::libraryFolder(&kAnchor);
    std::error_code error;
    for (const std::filesystem::path& folder :
         {own / "data", own.parent_path().parent_path() / "share" / "metamer" / "data"}) {
      if (std::filesystem::exists(folder / "manifest.json", error)) {
        return DataLibrary::open(folder);
      }
    }
  }
  return DataLibrary::openDefault();
}

std::vector<std::string> spaceNames(const DataLibrary& library) {
  std::vector<std::string> names;
  for (const auto& space : library.colourSpaces()) {
    names.push_back(space.name);
  }
  return names;
}

nb::dict provenance(const DataLibrary& library, const std::string& group, const std::string& name) {
  const spectral::Provenance found = library.provenance(group, name);
  nb::dict result;
  result["name"] = found.name;
  result["file"] = found.file;
  result["sha256"] = found.sha256;
  result["source"] = found.source;
  result["licence"] = found.licence;
  return result;
}

constexpr const char* kFolder = "A name, or a file, relative to `folder` (of the process where it is empty).";

}  // namespace

const DataLibrary& libraryOr(const DataLibrary* library) {
  if (library != nullptr) {
    return *library;
  }
  static const DataLibrary kUsual = openUsual();
  return kUsual;
}

void bindLibrary(nb::module_& module) {
  nb::class_<DataLibrary>(module, "Library",
                          "The measured tables: lights, observers, filters, reflectances, colour spaces, by name.\n"
                          "Names are matched without regard to case.")
      .def(
          "__init__",
          [](DataLibrary* self, const std::optional<std::filesystem::path>& folder) {
            new (self) DataLibrary(folder ? DataLibrary::open(*folder) : openUsual());
          },
          "folder"_a = nb::none(), nb::sig("def __init__(self, folder: str | os.PathLike[str] | None = None) -> None"),
          "The tables of a folder; of $METAMER_DATA, else the module's own, where none is given.")
      .def_prop_ro("illuminants", &DataLibrary::illuminantNames)
      .def_prop_ro("observers", &DataLibrary::observerNames)
      .def_prop_ro("filters", &DataLibrary::filterNames)
      .def_prop_ro("reflectance_sets", &DataLibrary::reflectanceSetNames)
      .def_prop_ro("spaces", &spaceNames)
      .def("illuminant", &DataLibrary::illuminant, "name"_a, "folder"_a = "",
           nb::sig("def illuminant(self, name: str, folder: str | os.PathLike[str] = '') -> Spectrum"),
           "\"D65\", \"HP1\", ...; \"3200 K\" is a blackbody, \"daylight 5600 K\" a CIE daylight; or a file.")
      .def("observer", &DataLibrary::observer, "name"_a, "folder"_a = "",
           nb::sig("def observer(self, name: str, folder: str | os.PathLike[str] = '') -> Observer"), kFolder)
      .def("filter", &DataLibrary::filter, "name"_a, "folder"_a = "",
           nb::sig("def filter(self, name: str, folder: str | os.PathLike[str] = '') -> Spectrum"), kFolder)
      .def(
          "reflectances",
          [](const DataLibrary& self, const std::string& name, const std::filesystem::path& folder) {
            return self.reflectances(name, folder).samples;
          },
          "name"_a, "folder"_a = "",
          nb::sig("def reflectances(self, name: str, folder: str | os.PathLike[str] = '') -> list[Spectrum]"), kFolder)
      .def("provenance", &provenance, "group"_a, "name"_a,
           nb::sig("def provenance(self, group: str, name: str) -> dict[str, str]"),
           "Table, SHA-256, source and licence of a name. `group`: illuminants, observers, filters, reflectances or\n"
           "rgb_spaces.");
}

}  // namespace metamer::python
