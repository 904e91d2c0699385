// SPDX-License-Identifier: Apache-2.0
#include "metamer/spectral/data_library.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <thread>

#include "metamer/spectral/platform.h"
#include "spectral/fixture.h"

namespace metamer::spectral {
namespace {

namespace fs = std::filesystem;

class DataLibraryTest : public testing::Test {
 protected:
  void SetUp() override {
    const auto* const info = testing::UnitTest::GetInstance()->current_test_info();
    m_folder = fs::path(testing::TempDir()) / (std::string("metamer_") + info->name() + std::to_string(getpid()));
    fs::create_directories(m_folder);
  }
  void TearDown() override { fs::remove_all(m_folder); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(m_folder / name, std::ios::binary) << text;
  }
  std::string openError(const std::string& manifest) const {
    write("manifest.json", manifest);
    std::string error = errorOf([&] { DataLibrary::open(m_folder); });
    const std::string where = (m_folder / "manifest.json").string();
    return error.rfind(where, 0) == 0 ? error.substr(where.size()) : error;
  }

  fs::path m_folder;
  const DataLibrary& m_library = testLibrary();
};

TEST_F(DataLibraryTest, EveryNameCanBeRead) {
  for (const std::string& name : m_library.illuminantNames()) {
    EXPECT_EQ(m_library.illuminant(name).quantity(), SpectralQuantity::SpectralPowerDistribution);
  }
  for (const std::string& name : m_library.filterNames()) {
    EXPECT_EQ(m_library.filter(name).quantity(), SpectralQuantity::Transmittance);
  }
  for (const std::string& name : m_library.observerNames()) {
    EXPECT_EQ(m_library.observer(name).name, name);
  }
  for (const std::string& name : m_library.reflectanceSetNames()) {
    EXPECT_FALSE(m_library.reflectances(name).samples.empty());
  }
  for (const ColourSpace& space : m_library.colourSpaces()) {
    EXPECT_EQ(m_library.colourSpace(space.name).name, space.name);
  }
}

TEST_F(DataLibraryTest, NamesWithoutRegardToCase) {
  EXPECT_EQ(m_library.illuminant("d65").values(), m_library.illuminant("D65").values());
  EXPECT_EQ(m_library.observer("cie 1931 2").name, "CIE 1931 2");
  EXPECT_EQ(m_library.colourSpace("ACESCG").name, "ACEScg");
}

TEST_F(DataLibraryTest, ANameWithASlashIsLookedUpInTheTablesFirst) {
  EXPECT_EQ(m_library.illuminant("60 A/W (Soft White)").name(), "60 A/W (Soft White)");
}

TEST_F(DataLibraryTest, TemperaturesAreFormulas) {
  EXPECT_EQ(m_library.illuminant("3200 K").name(), "3200 K");
  EXPECT_EQ(m_library.illuminant("3200k").shape().intervalNm, 1);
  EXPECT_EQ(m_library.illuminant("Daylight 5600 K").name(), "daylight 5600 K");
}

TEST_F(DataLibraryTest, ObserversKnowTheirResponse) {
  const Observer xyz = m_library.observer("CIE 1931 2");
  EXPECT_EQ(xyz.response, Observer::Response::Xyz);
  EXPECT_EQ(xyz.xyzFromResponse, Eigen::Matrix3d::Identity());
  EXPECT_EQ(m_library.observer("CIE 2006 LMS 2").response, Observer::Response::Lms);
  const Observer red = m_library.observer("Red Mysterium X (fit)");
  EXPECT_EQ(red.response, Observer::Response::Camera);
  ASSERT_TRUE(red.xyzFromResponse.has_value());
  EXPECT_EQ((*red.xyzFromResponse)(0, 1), 0.775);  // rows are X, Y, Z
  EXPECT_FALSE(m_library.observer("Nikon D5100").xyzFromResponse.has_value());
}

TEST_F(DataLibraryTest, UnknownNamesListTheNearest) {
  EXPECT_EQ(errorOf([&] { m_library.illuminant("FL111"); }),
            "illuminant 'FL111': unknown; near names: FL11, FL1; all names: lutgen list illuminants");
  EXPECT_EQ(errorOf([&] {
              m_library.observer("CIE 1932 2");
            }).rfind("observer 'CIE 1932 2': unknown; near names: CIE 1931 2", 0),
            0U);
  EXPECT_EQ(errorOf([&] { m_library.filter("zirconium"); }),
            "filter 'zirconium': unknown; all names: lutgen list filters");
  EXPECT_EQ(errorOf([&] { m_library.colourSpace("ACEScgt"); }),
            "space 'ACEScgt': unknown; near names: ACEScct, ACEScg; all names: lutgen list spaces");
  EXPECT_NE(errorOf([&] { m_library.illuminant(""); }), "no InputError");
  EXPECT_NE(errorOf([&] { m_library.illuminant(std::string(1'000'000, 'x')); }), "no InputError");
}

TEST_F(DataLibraryTest, FilesAreRelativeToTheBaseFolder) {
  write("gel.csv", "400,0.5\n700,0.25\n");
  write("camera.csv", "nm,R,G,B\n400,1,2,3\n700,1,2,3\n");
  write("eye.csv", "nm,x_bar,y_bar,z_bar\n400,1,2,3\n700,1,2,3\n");
  EXPECT_EQ(m_library.filter("gel.csv", m_folder).at(400), 0.5);
  EXPECT_EQ(m_library.filter((m_folder / "gel.csv").string(), "/nowhere").at(400), 0.5);
  EXPECT_EQ(m_library.observer("camera.csv", m_folder).response, Observer::Response::Camera);
  EXPECT_EQ(m_library.observer("eye.csv", m_folder).response, Observer::Response::Xyz);
  EXPECT_EQ(m_library.reflectances("gel.csv", m_folder).samples.size(), 1U);
  EXPECT_EQ(errorOf([&] { m_library.filter("camera.csv", m_folder); }).rfind((m_folder / "camera.csv").string(), 0),
            0U);
  EXPECT_EQ(
      errorOf([&] { m_library.illuminant("camera.csv", m_folder); }),
      (m_folder / "camera.csv").string() + ": columns '3': are several curves; name one as FILE:COLUMN, of: R, G, B");
  EXPECT_EQ(errorOf([&] { m_library.observer("gel.csv", m_folder); }),
            (m_folder / "gel.csv").string() + ": columns '2': must be 4, a wavelength and three responses");
}

TEST_F(DataLibraryTest, Provenance) {
  const Provenance table = m_library.provenance("illuminants", "hp1");
  EXPECT_EQ(table.file, "illuminants/cie_hp.csv");
  EXPECT_EQ(table.sha256.size(), 64U);
  EXPECT_EQ(table.licence, "BSD-3-Clause");
  const Provenance formula = m_library.provenance("illuminants", "3200 K");
  EXPECT_EQ(formula.file, "");
  EXPECT_NE(formula.source, "");
  EXPECT_EQ(m_library.provenance("illuminants", "daylight 5600 K").file, "illuminants/cie_daylight_components.csv");
  const Provenance file = m_library.provenance("filters", "./gel.csv");
  EXPECT_EQ(file.file, "./gel.csv");
  EXPECT_EQ(file.sha256, "");
  EXPECT_EQ(m_library.provenance("rgb_spaces", "ACEScct").file, "rgb_spaces.json");
  EXPECT_NE(errorOf([&] { m_library.provenance("filters", "none such"); }), "no InputError");
}

TEST_F(DataLibraryTest, ThreadsShareOneLibrary) {
  const DataLibrary library = DataLibrary::open(METAMER_DATA_FOLDER);
  std::vector<std::thread> threads;
  std::vector<double> sums(8);
  for (std::size_t t = 0; t < sums.size(); ++t) {
    threads.emplace_back([&library, &sum = sums[t]] {
      for (const std::string& name : library.illuminantNames()) {
        sum += library.illuminant(name).at(560);
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  for (const double sum : sums) {
    EXPECT_EQ(sum, sums[0]);
  }
}

TEST_F(DataLibraryTest, RefusesAManifestThatIsNotComplete) {
  EXPECT_EQ(errorOf([&] { DataLibrary::open(m_folder); }), (m_folder / "manifest.json").string() + ": no such file");
  EXPECT_EQ(openError("{"), ": JSON: malformed at byte 2; the file may be cut short");
  EXPECT_EQ(openError("{}"), ": metamer_data 'null': must be 1; use the data folder of this release");
  EXPECT_EQ(openError(R"({"metamer_data": 2})"), ": metamer_data '2': must be 1; use the data folder of this release");
  EXPECT_EQ(openError(R"({"metamer_data": 1})"), ": tables: must be a list");
  const std::string start = R"({"metamer_data": 1, "tables": [{"file": "a.csv", "group": "illuminants", "source": "s",)"
                            R"( "sha256": "0", "names": ["a"], "quantity": "spectral power distribution")";
  EXPECT_EQ(openError(start + R"(, "licence": "MIT"}]})"), ": a.csv: unit: is missing");
  EXPECT_EQ(openError(start + R"(, "unit": "", "licence": "MIT"}]})"), ": a.csv: unit: is missing");
  EXPECT_EQ(openError(start + R"(, "unit": "relative"}]})"), ": a.csv: licence: is missing");
  EXPECT_EQ(openError(start + R"(, "unit": "relative", "licence": "MIT"}]})"), "no InputError");
}

TEST_F(DataLibraryTest, ATableThatDoesNotMatchIsRefusedAndReadAgain) {
  write("manifest.json",
        R"({"metamer_data": 1, "tables": [{"file": "a.csv", "group": "illuminants", "source": "s", "sha256": "0",)"
        R"( "names": ["a"], "quantity": "spectral power distribution", "unit": "relative", "licence": "MIT"}]})");
  write("a.csv", "nm,a,b\n400,1,2\n410,1,2\n");
  const DataLibrary library = DataLibrary::open(m_folder);
  EXPECT_EQ(errorOf([&] { library.illuminant("a"); }),
            (m_folder / "a.csv").string() + ": columns '3': the manifest needs 2");
  write("a.csv", "nm,a\n400,1\n410,1\n");
  EXPECT_EQ(library.illuminant("a").at(400), 1);
  EXPECT_NE(errorOf([&] { library.colourSpaces(); }), "no InputError");
}

TEST_F(DataLibraryTest, TheDefaultFolderComesFromTheEnvironment) {
  const char* const before = std::getenv("METAMER_DATA");
  const std::string kept = before == nullptr ? "" : before;
  setenv("METAMER_DATA", METAMER_DATA_FOLDER, 1);
  EXPECT_FALSE(DataLibrary::openDefault().illuminantNames().empty());
  setenv("METAMER_DATA", m_folder.c_str(), 1);
  const std::string error = errorOf([] { DataLibrary::openDefault(); });
  EXPECT_NE(error.find(m_folder.string()), std::string::npos) << error;
  EXPECT_NE(error.find("share/metamer/data"), std::string::npos) << error;
  before == nullptr ? unsetenv("METAMER_DATA") : setenv("METAMER_DATA", kept.c_str(), 1);
}

TEST(PlatformTest, ProgramFolderHoldsThisProgram) {
  ASSERT_FALSE(programFolder().empty());
  EXPECT_TRUE(fs::is_directory(programFolder()));
}

}  // namespace
}  // namespace metamer::spectral
