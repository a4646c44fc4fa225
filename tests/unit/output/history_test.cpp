#include "output/history.hpp"

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "base/error.hpp"
#include "scratch.hpp"
#include "support/catch.hpp"

using namespace scree;

namespace {

const std::vector<HistoryColumn> kColumns = {{"", "time", "s", "simulated time"},
                                             {"energy", "kinetic", "J", "kinetic energy"},
                                             {"reactions/pin, left", "force_x", "N", "force of the joint"}};

std::vector<std::string> lines_of(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

void append_rows(HistoryWriter& writer, int rows) {
  for (int i = 0; i < rows; ++i) {
    const Real row = static_cast<Real>(writer.rows());
    writer.append({row, row / 3, -row * 1e-300});
  }
}

}  // namespace

TEST_CASE("history returns as written, with units") {
  ScratchDirectory scratch;
  HistoryWriter writer(scratch.path(), kColumns, false, 0);
  append_rows(writer, 700);
  writer.flush();
  append_rows(writer, 5);
  writer.flush();
  writer.flush();
  const Hdf5File file(scratch / "history.h5", Hdf5Access::read);
  const auto kinetic = file.read_array<Real>("/energy/kinetic");
  REQUIRE(kinetic.size() == 705);
  CHECK(kinetic[704] == 704.0 / 3);
  CHECK(file.read_text_attribute("/energy/kinetic", "unit") == "J");
  CHECK(file.read_text_attribute("/reactions/pin, left/force_x", "description") == "force of the joint");
  CHECK(!std::filesystem::exists(scratch / "history.csv"));
}

TEST_CASE("the CSV reads back as the same numbers") {
  ScratchDirectory scratch;
  HistoryWriter writer(scratch.path(), kColumns, true, 0);
  writer.append({0.1, 1.0 / 3, -0.0});
  writer.append({1e-320, NAN, INFINITY});
  writer.flush();
  append_rows(writer, 1);
  writer.flush();
  const auto lines = lines_of(scratch / "history.csv");
  REQUIRE(lines.size() == 4);
  CHECK(lines[0] == "time [s],energy/kinetic [J],\"reactions/pin, left/force_x [N]\"");
  CHECK(lines[1] == "0.1,0.3333333333333333,-0");
  CHECK(lines[2] == "1e-320,nan,inf");
  CHECK(std::stod(lines[1].substr(4)) == 1.0 / 3);
}

TEST_CASE("a restarted history cuts off later rows and continues") {
  ScratchDirectory scratch;
  {
    HistoryWriter writer(scratch.path(), kColumns, false, 0);
    append_rows(writer, 20);
    writer.flush();
  }
  HistoryWriter writer(scratch.path(), kColumns, true, 15);
  CHECK(writer.rows() == 15);
  append_rows(writer, 2);
  writer.flush();
  const auto time = Hdf5File(scratch / "history.h5", Hdf5Access::read).read_array<Real>("/time");
  REQUIRE(time.size() == 17);
  for (std::size_t row = 0; row < time.size(); ++row) CHECK(time[row] == static_cast<Real>(row));
  CHECK(lines_of(scratch / "history.csv").size() == 18);
}

TEST_CASE("a restarted history renames the columns of earlier versions") {
  ScratchDirectory scratch;
  std::vector<HistoryColumn> columns = kColumns;
  columns[1] = {"step", "left", "1", "particles that have left"};
  {
    HistoryWriter first(scratch.path(), columns, false, 0);
    append_rows(first, 5), first.flush();
  }
  columns[1].name = "particles_escaped";
  HistoryWriter second(scratch.path(), columns, true, 4);
  append_rows(second, 2), second.flush();
  const Hdf5File file(scratch / "history.h5", Hdf5Access::read);
  CHECK(file.dataset_names("/").size() == columns.size());
  CHECK(file.read_array<Real>("/step/particles_escaped").size() == 6);
  CHECK(file.read_array<Real>("/step/particles_escaped")[3] == 1);
  CHECK(lines_of(scratch / "history.csv").size() == 7);
}

TEST_CASE("a history that does not fit is refused") {
  ScratchDirectory scratch;
  CHECK_THROWS_AS(HistoryWriter(scratch.path(), kColumns, false, 3), IoError);
  {
    HistoryWriter writer(scratch.path(), kColumns, false, 0);
    append_rows(writer, 20);
    writer.flush();
    CHECK_THROWS_AS(writer.append({1, 2}), SimulationError);
  }
  CHECK_THROWS_AS(HistoryWriter(scratch.path(), kColumns, false, 21), IoError);
  auto more = kColumns;
  more.push_back({"bodies/bob", "x", "m", "position"});
  const auto message = [&](const std::vector<HistoryColumn>& columns) {
    try {
      HistoryWriter(scratch.path(), columns, false, 20);
    } catch (const IoError& error) {
      return std::string(error.what());
    }
    return std::string("nothing was refused");
  };
  CHECK(message(more).find("lacks the column that the restarted run is to write, bodies/bob/x; keep "
                           "output.history_bodies unchanged") != std::string::npos);
  auto fewer = kColumns;
  fewer.pop_back();
  CHECK(message(fewer).find("keep output.history_reactions unchanged") != std::string::npos);
  CHECK_THROWS_AS(HistoryWriter(scratch / "no_such_directory", kColumns, true, 0), IoError);
}
