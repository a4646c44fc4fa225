#include "output/snapshot.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <filesystem>

#include "base/error.hpp"
#include "scratch.hpp"
#include "support/catch.hpp"
#include "support/hdf5_texts.hpp"

using namespace scree;

namespace {

// Two triangles that share an edge.
const SeriesTriangles kTriangles{{0, 1, 2, 2, 1, 3}, {{"body", "body of the mesh", {4, 4}}}};

SnapshotWriter surface_writer(const ScratchDirectory& scratch, int keep,
                              const SeriesTriangles& triangles = kTriangles) {
  return {scratch.path(), {.title = "title", .keep = keep, .triangles = triangles}};
}

// Snapshots from the writer's next one to `end`, whose values encode their positions.
void write_surfaces(SnapshotWriter& writer, int end) {
  for (int step = writer.snapshots(); step < end; ++step) {
    const Real v = PredictableSnapshot::value(step, 0);
    const std::vector<Vec3> corners{{v, 0, 0}, {v + 1, 0, 0}, {v, 1, 0}, {v + 1, 1, 0}}, shear{{v, 0, 1}, {}};
    const std::vector<Real> pressure{v + 5, v + 6};
    const PredictableSnapshot of(step, 2, 1);
    writer.append(of.time, of.particles(), of.bodies(), {corners, pressure, shear});
  }
}

// Contacts and joints, with values that encode their positions.
const WantedLines kLinesWanted{true, {"overlap", "kind"}, 0, {"spring", "pin"}};

SnapshotWriter line_writer(const ScratchDirectory& scratch, int keep,
                           const WantedLines& lines = kLinesWanted) {
  return {scratch.path(), {.title = "title", .keep = keep, .names = {{kBodyNames, {"body"}}}}, lines};
}

// Snapshots with so many contacts from the writer's next one on.
void write_lines(SnapshotWriter& writer, const std::vector<int>& contacts) {
  for (const int n : contacts) {
    const int step = writer.snapshots();
    const auto ends = [&](int lines) {
      std::vector<Vec3> at;
      for (int k = 0; k < 2 * lines; ++k) at.push_back({PredictableSnapshot::value(step, k), 0, 1});
      return at;
    };
    const std::vector<Vec3> of_contacts = ends(n), of_joints = ends(2);
    std::vector<Real> overlap;
    for (int k = 0; k < n; ++k) overlap.push_back(PredictableSnapshot::value(step, k));
    const std::vector<int> kind(static_cast<std::size_t>(n), step);
    const std::vector<Real> force{step + 0.25, step + 0.5};
    const PredictableSnapshot of(step, 2, 0);
    writer.append(
        of.time, of.particles(), of.bodies(), {},
        {of_contacts,
         {{"overlap", {"m", "overlap"}, 1, overlap.data()}, {"kind", {"1", "kind"}, 1, kind.data()}}},
        {of_joints, {{"force", {"N", "force"}, 1, force.data()}}});
  }
}

}  // namespace

TEST_CASE("snapshots of changing size return as written") {
  ScratchDirectory scratch;
  const std::vector<int> counts = {5, 5, 3, 0, 0, 7, 300};
  SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
  write_snapshots(writer, counts, 0);
  CHECK(writer.snapshots() == 7);
  CHECK(read_predictable_particles(scratch / "particles.vtkhdf") == counts);
  CHECK(!std::filesystem::exists(scratch / "bodies.vtkhdf"));
}

TEST_CASE("snapshots of equal size share their vertices") {
  ScratchDirectory scratch;
  SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
  write_snapshots(writer, {5, 5, 3, 3, 3, 5}, 0);
  const Hdf5File file(scratch / "particles.vtkhdf", Hdf5Access::read);
  CHECK(file.read_array<std::int64_t>("/VTKHDF/Steps/PartOffsets") ==
        std::vector<std::int64_t>{0, 0, 1, 1, 1, 2});
  CHECK(file.read_array<std::int64_t>("/VTKHDF/NumberOfPoints") == std::vector<std::int64_t>{5, 3, 5});
  CHECK(file.rows("/VTKHDF/Vertices/Connectivity") == 13);
  CHECK(file.rows("/VTKHDF/Points") == 24);
}

TEST_CASE("bodies have a series of their own") {
  ScratchDirectory scratch;
  SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
  write_snapshots(writer, {2, 2, 2}, 4);
  const Hdf5File file(scratch / "bodies.vtkhdf", Hdf5Access::read);
  CHECK(file.rows("/VTKHDF/Points") == 12);
  CHECK(file.read_array<int>("/VTKHDF/PointData/body") == std::vector<int>{0, 1, 2, 3});
  CHECK(file.read_array<std::int64_t>("/VTKHDF/Steps/PointDataOffsets/body") ==
        std::vector<std::int64_t>{0, 0, 0});
  CHECK(file.read_array<Real>("/VTKHDF/PointData/angle")[9] == 2001);
}

TEST_CASE("triangles are written once, and their corners and what acts on them at every snapshot") {
  ScratchDirectory scratch;
  SnapshotWriter writer = surface_writer(scratch, 0);
  write_surfaces(writer, 3);
  const Hdf5File file(scratch / "surfaces.vtkhdf", Hdf5Access::read);
  const auto integers = [&](const char* name) { return file.read_array<std::int64_t>(name); };
  CHECK(integers("/VTKHDF/Polygons/Connectivity") == kTriangles.corners);
  CHECK(integers("/VTKHDF/Polygons/Offsets") == std::vector<std::int64_t>{0, 3, 6});
  CHECK(integers("/VTKHDF/Steps/PointOffsets") == std::vector<std::int64_t>{0, 4, 8});
  CHECK(integers("/VTKHDF/Steps/CellDataOffsets/shear") == std::vector<std::int64_t>{0, 2, 4});
  CHECK(integers("/VTKHDF/Steps/CellDataOffsets/body") == std::vector<std::int64_t>{0, 0, 0});
  CHECK(file.read_array<int>("/VTKHDF/CellData/body") == std::vector<int>{4, 4});
  CHECK(file.read_array<Real>("/VTKHDF/CellData/pressure") ==
        std::vector<Real>{5, 6, 1005, 1006, 2005, 2006});
  CHECK(file.read_array<Real>("/VTKHDF/CellData/shear")[12] == 2000);
  CHECK(file.rows("/VTKHDF/Points") == 12);
}

TEST_CASE("a restarted run continues with the triangles that it has written, and with no others") {
  ScratchDirectory scratch;
  const auto contents = [&] {
    const Hdf5File file(scratch / "surfaces.vtkhdf", Hdf5Access::read);
    return std::pair(file.read_array<Real>("/VTKHDF/CellData/pressure"),
                     file.read_array<std::int64_t>("/VTKHDF/Steps/TriangleOffsets"));
  };
  {
    SnapshotWriter writer = surface_writer(scratch, 0);
    write_surfaces(writer, 5);
  }
  const auto whole = contents();
  {
    SnapshotWriter writer = surface_writer(scratch, 2);
    CHECK(contents().first.size() == 4);
    CHECK(Hdf5File(scratch / "surfaces.vtkhdf", Hdf5Access::read).rows("/VTKHDF/Points") == 8);
    write_surfaces(writer, 5);
    writer.finish();
  }
  CHECK(contents() == whole);
  CHECK(occurrences(file_text(scratch / "surfaces.xdmf"), "<Time") == 5);
  SeriesTriangles others = kTriangles;
  others.corners[5] = 0;
  CHECK_THROWS_AS(surface_writer(scratch, 5, others), IoError);
  others = kTriangles, others.numbers[0].values[1] = 3;
  CHECK_THROWS_AS(surface_writer(scratch, 5, others), IoError);
  others = kTriangles, others.fields = {"shear", "pressure"};
  CHECK_NOTHROW(surface_writer(scratch, 5, others));
  others.fields->emplace_back("sliding_work");
  CHECK_THROWS_AS(surface_writer(scratch, 5, others), IoError);
  std::filesystem::remove(scratch / "surfaces.vtkhdf");
  SnapshotWriter writer = surface_writer(scratch, 5);
  CHECK_THROWS_AS(write_surfaces(writer, 6), IoError);
}

TEST_CASE("lines of changing number return as written, those of the same number share their cells") {
  ScratchDirectory scratch;
  SnapshotWriter writer = line_writer(scratch, 0);
  write_lines(writer, {0, 2, 2, 3});
  writer.finish();
  using Integers = std::vector<std::int64_t>;
  const Hdf5File file(scratch / "contacts.vtkhdf", Hdf5Access::read);
  const auto integers = [&](const char* name) { return file.read_array<std::int64_t>(name); };
  CHECK(integers("/VTKHDF/NumberOfPoints") == Integers{0, 4, 6});
  CHECK(integers("/VTKHDF/Lines/NumberOfCells") == Integers{0, 2, 3});
  CHECK(integers("/VTKHDF/Lines/NumberOfConnectivityIds") == Integers{0, 4, 6});
  CHECK(integers("/VTKHDF/Lines/Offsets") == Integers{0, 0, 2, 4, 0, 2, 4, 6});
  CHECK(integers("/VTKHDF/Lines/Connectivity") == Integers{0, 1, 2, 3, 0, 1, 2, 3, 4, 5});
  CHECK(integers("/VTKHDF/Vertices/Offsets") == Integers{0, 0, 0});
  CHECK(integers("/VTKHDF/Steps/PartOffsets") == Integers{0, 1, 1, 2});
  CHECK(integers("/VTKHDF/Steps/PointOffsets") == Integers{0, 0, 4, 8});
  CHECK(integers("/VTKHDF/Steps/CellDataOffsets/kind") == Integers{0, 0, 2, 4});
  CHECK(integers("/VTKHDF/Steps/CellOffsets") == Integers{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0});
  CHECK(integers("/VTKHDF/Steps/ConnectivityIdOffsets") ==
        Integers{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 4, 0, 0});
  CHECK(file.read_array<Real>("/VTKHDF/CellData/overlap") ==
        std::vector<Real>{1000, 1001, 2000, 2001, 3000, 3001, 3002});
  CHECK(file.read_array<int>("/VTKHDF/CellData/kind") == std::vector{1, 1, 2, 2, 3, 3, 3});
  CHECK(file.read_text("/Scree/names") == "body\n");
  const std::string text = file_text(scratch / "contacts.xdmf");
  CHECK(occurrences(text, "TopologyType=\"Polyline\"") == 3);
  CHECK(occurrences(text, "Center=\"Cell\"") == 6);
  const Hdf5File links(scratch / "links.vtkhdf", Hdf5Access::read);
  CHECK(links.read_text("/Scree/names") == "spring\npin\n");
  CHECK(links.read_array<Real>("/VTKHDF/CellData/force") ==
        std::vector<Real>{0.25, 0.5, 1.25, 1.5, 2.25, 2.5, 3.25, 3.5});
}

TEST_CASE("a restarted run continues with its lines, and with no others") {
  ScratchDirectory scratch;
  const auto contents = [&](const char* name) {
    const Hdf5File file(scratch / name, Hdf5Access::read);
    std::vector<std::vector<std::int64_t>> all;
    for (const std::string& dataset : file.dataset_names("/VTKHDF/"))
      if (dataset.find("Data/") == std::string::npos && dataset != "Points" && dataset != "Steps/Values")
        all.push_back(file.read_array<std::int64_t>("/VTKHDF/" + dataset));
    return std::pair(all, file.read_array<Real>("/VTKHDF/Points"));
  };
  {
    SnapshotWriter writer = line_writer(scratch, 0);
    write_lines(writer, {1, 2, 2, 0, 3});
  }
  const auto contacts = contents("contacts.vtkhdf"), links = contents("links.vtkhdf");
  {
    SnapshotWriter writer = line_writer(scratch, 2);
    CHECK(Hdf5File(scratch / "contacts.vtkhdf", Hdf5Access::read).rows("/VTKHDF/CellData/kind") == 3);
    write_lines(writer, {2, 0, 3});
    writer.finish();
  }
  CHECK(contents("contacts.vtkhdf") == contacts);
  CHECK(contents("links.vtkhdf") == links);
  CHECK(occurrences(file_text(scratch / "links.xdmf"), "<Time") == 5);
  WantedLines other = kLinesWanted;
  other.contact_fields.emplace_back("slip");
  CHECK_THROWS_AS(line_writer(scratch, 5, other), IoError);
  other = kLinesWanted, other.contacts = false;
  CHECK_THROWS_AS(line_writer(scratch, 5, other), IoError);
  other = kLinesWanted, other.links = {};
  CHECK_THROWS_AS(line_writer(scratch, 5, other), IoError);
  CHECK_NOTHROW(line_writer(scratch, 5));
  std::filesystem::remove(scratch / "links.vtkhdf");
  CHECK_THROWS_AS(line_writer(scratch, 5), IoError);
}

TEST_CASE("every dataset has its unit and a description") {
  ScratchDirectory scratch;
  SnapshotWriter writer(scratch.path(), {.title = "a title with an ü", .keep = 0, .triangles = kTriangles});
  write_surfaces(writer, 1);
  for (const char* name : {"particles.vtkhdf", "bodies.vtkhdf", "surfaces.vtkhdf"}) {
    const Hdf5File file(scratch / name, Hdf5Access::read);
    const auto datasets = file.dataset_names("/VTKHDF");
    CHECK(datasets.size() > 15);
    for (const std::string& dataset : datasets) {
      CAPTURE(dataset);
      CHECK(!file.read_text_attribute("/VTKHDF/" + dataset, "unit").empty());
      CHECK(!file.read_text_attribute("/VTKHDF/" + dataset, "description").empty());
    }
    CHECK(file.read_text_attribute("/Scree", "title") == "a title with an ü");
    CHECK(file.read_text_attribute("/VTKHDF", "Type") == "PolyData");
  }
}

TEST_CASE("a restarted run cuts off later snapshots and continues") {
  ScratchDirectory scratch;
  {
    SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
    write_snapshots(writer, {5, 4, 4, 6, 6}, 3);
  }
  SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 3});
  CHECK(read_predictable_particles(scratch / "particles.vtkhdf") == std::vector<int>{5, 4, 4});
  write_snapshots(writer, {4, 2}, 3);
  writer.finish();
  CHECK(read_predictable_particles(scratch / "particles.vtkhdf") == std::vector<int>{5, 4, 4, 4, 2});
  CHECK(Hdf5File(scratch / "bodies.vtkhdf", Hdf5Access::read).rows("/VTKHDF/Points") == 15);
  CHECK(occurrences(file_text(scratch / "particles.xdmf"), "<Time") == 5);
}

TEST_CASE("names are in the files whose fields count them, and with every snapshot") {
  ScratchDirectory scratch;
  SeriesOptions options{.title = "title", .keep = 0};
  options.names = {{kBodyNames, {"a", "bü"}}, {kMaterialNames, {"steel"}}, {kGroupNames, {}}};
  {
    SnapshotWriter writer(scratch.path(), options);
    write_snapshots(writer, {2, 2, 2}, 2);
  }
  options.keep = 1;
  SnapshotWriter writer(scratch.path(), options);
  write_snapshots(writer, {3}, 2);
  const Hdf5File bodies(scratch / "bodies.vtkhdf", Hdf5Access::read),
      particles(scratch / "particles.vtkhdf", Hdf5Access::read);
  CHECK(bodies.dataset_names("/Scree") == std::vector<std::string>{"materials", "names"});
  CHECK(particles.dataset_names("/Scree") == std::vector<std::string>{"materials"});
  CHECK(bodies.read_text("/Scree/names") == "a\nbü\n");
  CHECK(read_texts(bodies, "/VTKHDF/FieldData/names") == std::vector<std::string>{"a", "bü"});
  CHECK(bodies.read_array<std::int64_t>("/VTKHDF/Steps/FieldDataSizes/names") ==
        std::vector<std::int64_t>{1, 2, 1, 2});
  CHECK(bodies.read_array<std::int64_t>("/VTKHDF/Steps/FieldDataOffsets/names") ==
        std::vector<std::int64_t>{0, 0});
}

TEST_CASE("a file without a field that is to be written is left as it is") {
  ScratchDirectory scratch;
  {
    SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
    write_snapshots(writer, {2}, 2);
  }
  SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 1});
  const PredictableSnapshot next(1, 2, 2);
  BodySnapshot bodies = next.bodies();
  const std::vector<Real> turns(8);
  bodies.orientation = turns, bodies.spin = next.vector;
  std::string message;
  try {
    writer.append(next.time, next.particles(), bodies);
  } catch (const IoError& error) {
    message = error.what();
  }
  CHECK(message.find("bodies.vtkhdf: lacks the field orientation") != std::string::npos);
  CHECK(Hdf5File(scratch / "bodies.vtkhdf", Hdf5Access::read).rows("/VTKHDF/Points") == 2);
  CHECK(read_predictable_particles(scratch / "particles.vtkhdf") == std::vector<int>{2});
}

TEST_CASE("the XDMF is complete at every snapshot, and written a few times only") {
  ScratchDirectory scratch;
  SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
  const std::string path = scratch / "bodies.xdmf";
  std::size_t written = 0;
  std::filesystem::file_time_type last{};
  for (int step = 0; step < 200; ++step) {
    write_snapshots(writer, {3}, 1);
    const std::string text = file_text(path);
    const int known = occurrences(text, "<Time");
    CHECK(text.find("</Xdmf>\n") == text.size() - 8);
    CHECK(known <= writer.snapshots());
    CHECK(6 * known >= 5 * writer.snapshots());
    if (const auto time = std::filesystem::last_write_time(path); time != last)
      last = time, written += text.size();
  }
  writer.finish();
  CHECK(occurrences(file_text(path), "<Time") == 200);
  CHECK(written < 6 * file_text(path).size());
  CHECK(!std::filesystem::exists(path + ".tmp"));
}

TEST_CASE("files that do not fit the restarted run are refused") {
  ScratchDirectory scratch;
  CHECK_THROWS_AS(SnapshotWriter(scratch.path(), {.title = "title", .keep = 1}), IoError);
  {
    SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
    write_snapshots(writer, {5, 5}, 2);
  }
  CHECK_THROWS_AS(SnapshotWriter(scratch.path(), {.title = "title", .keep = 3}), IoError);
  std::filesystem::remove(scratch / "bodies.vtkhdf");
  SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 2});
  CHECK_THROWS_AS(write_snapshots(writer, {5}, 2), IoError);
  std::filesystem::resize_file(scratch / "particles.vtkhdf", 2000);
  CHECK_THROWS_AS(SnapshotWriter(scratch.path(), {.title = "title", .keep = 2}), IoError);
}

TEST_CASE("a new run replaces old files and leaves nothing beside them") {
  ScratchDirectory scratch;
  {
    SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
    write_snapshots(writer, {5, 5, 5}, 2);
  }
  {
    SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
    CHECK(!std::filesystem::exists(scratch / "particles.vtkhdf"));
    write_snapshots(writer, {1, 1}, 0);
  }
  CHECK(read_predictable_particles(scratch / "particles.vtkhdf") == std::vector<int>{1, 1});
  const std::filesystem::directory_iterator files(scratch.path());
  CHECK(std::distance(begin(files), end(files)) == 2);
}

TEST_CASE("a reader that holds the file does not stop the writer") {
  ScratchDirectory scratch;
  SnapshotWriter writer(scratch.path(), {.title = "title", .keep = 0});
  write_snapshots(writer, {5, 5}, 0);
  const int reader = open((scratch / "particles.vtkhdf").c_str(), O_RDONLY);
  REQUIRE(flock(reader, LOCK_SH) == 0);  // as the HDF5 library of a reader does
  write_snapshots(writer, {5, 5, 5}, 0);
  close(reader);
  CHECK(read_predictable_particles(scratch / "particles.vtkhdf") == std::vector<int>{5, 5, 5, 5, 5});
}

TEST_CASE("the XDMF refers to every snapshot that has points") {
  ScratchDirectory scratch;
  SnapshotWriter writer(scratch.path(), {.title = "sand & <gravel>", .keep = 0});
  write_snapshots(writer, {5, 0, 3}, 0);
  const std::string text = file_text(scratch / "particles.xdmf");
  CHECK(occurrences(text, "<Time Value=\"0.5\"/>") == 1);
  CHECK(occurrences(text, "<Time") == 2);  // these readers crash on a grid without points
  CHECK(occurrences(text, "sand &amp; &lt;gravel&gt;") == 1);
  CHECK(occurrences(text, "particles.vtkhdf:/VTKHDF/PointData/velocity|5 0:1 1:3 3:8 3") == 1);
}
