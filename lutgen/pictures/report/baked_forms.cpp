// SPDX-License-Identifier: Apache-2.0
#include "report/baked_forms.h"

#include <array>
#include <fstream>
#include <random>

#include "metamer/ocio/bake.h"
#include "metamer/ocio/compared_transform.h"
#include "metamer/spectral/input_error.h"
#include "metamer/spectral/path_text.h"

namespace metamer::lutgen {
namespace {

struct Form {
  const char* label;
  const char* extension;
  bool isFull;  ///< its certificate
};
constexpr std::array<Form, 2> kForms = {{{".ctf (OpenColorIO)", ".ctf", true}, {".cube (33 nodes)", ".cube", false}}};

}  // namespace

WorkFolder::WorkFolder()
    : m_path(std::filesystem::temp_directory_path() /
             spectral::pathOf("lutgen-report-" + std::to_string(std::random_device()()))),
      m_unfinished(std::in_place, m_path) {
  std::filesystem::create_directory(m_path);
}

WorkFolder::~WorkFolder() {
  std::error_code none;
  std::filesystem::remove_all(m_path, none);
}

std::filesystem::path WorkFolder::place(const std::string& name) const {
  std::filesystem::path file = m_path / spectral::pathOf(name);
  m_files.try_emplace(name, file);
  return file;
}

std::filesystem::path WorkFolder::write(const std::string& name, std::string_view contents) const {
  std::filesystem::path file = place(name);
  std::ofstream stream(file, std::ios::binary);
  stream.write(contents.data(), static_cast<std::streamsize>(contents.size()));
  if (!stream.flush()) {
    throw spectral::InputError(spectral::utf8(file), "file", "",
                               "cannot be written; make room for temporary files, or set $TMPDIR");
  }
  return file;
}

std::vector<BakedForm> bakedForms(const sip::Recipe& recipe, const spectral::DataLibrary& library,
                                  const ocio::ConfigSource& config, const WorkFolder& folder,
                                  const std::function<void(double)>& progress) {
  const ocio::ComparedTransform exact = ocio::comparedRecipe(recipe, library, config);
  const std::string file = recipe.where.empty() ? recipe.name : recipe.where;
  const std::string recipeName = spectral::utf8(spectral::pathOf(file).filename());
  std::vector<BakedForm> forms;
  for (const Form& form : kForms) {
    const double done = static_cast<double>(forms.size()) / kForms.size();
    ocio::BakeOptions options;
    options.config = config;
    options.fullCertificate = form.isFull;
    options.progress = [&](double share) { progress(done + 0.8 * share / kForms.size()); };
    BakedForm baked;
    baked.label = form.label;
    baked.command = "lutgen bake " + recipeName + (form.isFull ? " --certify full -o " : " -o ") +
                    spectral::utf8(spectral::pathOf(recipeName).stem()) + form.extension;
    const std::filesystem::path lut = folder.place(std::string("report") + form.extension);
    folder.place(spectral::utf8(lut.filename()) + ".json");
    baked.certificate = ocio::bakeFile(recipe, library, lut, {}, options);
    const ocio::ComparedTransform written = ocio::comparedFile(lut, {}, library, config);
    baked.comparison = ocio::compareTransforms(exact, written, ocio::comparisonSpace(exact, written), library);
    baked.apply = written.apply;
    forms.push_back(std::move(baked));
  }
  progress(1);
  return forms;
}

}  // namespace metamer::lutgen
