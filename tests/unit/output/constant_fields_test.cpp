// Time-constant fields of particles in snapshots from which particles escape.
#include <tuple>

#include "base/error.hpp"
#include "output/snapshot.hpp"
#include "scratch.hpp"
#include "support/catch.hpp"

namespace scree {

TEST_CASE("fields that never change are written where the number of points changes, and pointed at else") {
  ScratchDirectory scratch;
  const std::vector<int> counts = {5, 5, 3, 3, 0, 0, 2};
  const auto open = [&](int keep) {
    return SnapshotWriter(scratch.path(), {.title = "title", .keep = keep, .constant = {"radius"}});
  };
  const auto contents = [&] {
    const Hdf5File file(scratch / "particles.vtkhdf", Hdf5Access::read);
    return std::tuple(file.read_array<Real>("/VTKHDF/PointData/radius"),
                      file.read_array<std::int64_t>("/VTKHDF/Steps/PointDataOffsets/radius"),
                      file.rows("/VTKHDF/PointData/global_id"), file.rows("/VTKHDF/PointData/contacts"));
  };
  {
    SnapshotWriter writer = open(0);
    write_snapshots(writer, counts, 0);
    writer.finish();
  }
  CHECK(read_predictable_particles(scratch / "particles.vtkhdf") == counts);
  const auto whole = contents();
  CHECK(whole ==
        std::tuple(std::vector<Real>{0.5, 1.5, 2.5, 3.5, 4.5, 2000.5, 2001.5, 2002.5, 6000.5, 6001.5},
                   std::vector<std::int64_t>{0, 0, 5, 5, 8, 8, 8}, 10, 18));
  CHECK(occurrences(file_text(scratch / "particles.xdmf"), "PointData/radius|5:1:3:8<") == 2);
  {
    SnapshotWriter writer = open(4);
    CHECK(std::get<0>(contents()).size() == 8);
    write_snapshots(writer, {0, 0, 2}, 0);
    writer.finish();
  }
  CHECK(contents() == whole);
}

TEST_CASE("files whose fields were all written at every snapshot are not continued") {
  ScratchDirectory scratch;
  const PredictableSnapshot of(0, 2, 0);
  const ParticleSnapshot particles = of.particles();
  const PointSnapshot snapshot{0, 2, {0, 2}, components(particles.position), particles.fields};
  {
    VtkHdfSeries series(scratch.path(), "particles", {.title = "title"});
    series.prepare(snapshot), series.show(), series.follow(snapshot);
  }
  const SeriesOptions later{.title = "title", .keep = 1, .constant = {"radius"}};
  CHECK_THROWS_AS(VtkHdfSeries(scratch.path(), "particles", later), IoError);
}

}  // namespace scree
