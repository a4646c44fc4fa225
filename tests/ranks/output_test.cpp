// Files written by several ranks: the same for every method of writing and number of ranks; a failure of one
// rank ends all.
#include <fcntl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/error.hpp"
#include "output/checkpoint.hpp"
#include "output/shared_rows.hpp"
#include "output/snapshot.hpp"
#include "partition/id_order.hpp"
#include "run/state/state.hpp"
#include "support/catch.hpp"
#include "support/checkpoint_arrays.hpp"
#include "support/file_size_limit.hpp"
#include "support/petsc_run.hpp"
#include "support/shared_folder.hpp"
#include "unit/output/scratch.hpp"

// Return value of the system call that reserves disk space; 0: the system's own.
static int reservation_error = 0;

extern "C" int fallocate(int file, int mode, off_t first, off_t count) {
  if (reservation_error == 0) return static_cast<int>(syscall(SYS_fallocate, file, mode, first, count));
  errno = reservation_error;
  return -1;
}

namespace scree {

namespace {

Ranks world() {
  petsc();
  return Ranks::world();
}

// The part of rank `rank` of `size` in n rows: uneven parts, the second of them empty.
RowPart uneven_part(std::int64_t n, int rank, int size) {
  const auto start = [&](int r) {
    return r >= size ? n : r <= 0 ? 0 : std::max<std::int64_t>(n / 3, r > 2 ? n * r / size : 0);
  };
  return {start(rank), start(rank + 1) - start(rank)};
}

std::int64_t value_of(std::int64_t row) { return row * 7919 % 104729; }

constexpr std::int64_t kRows = 300000;  // some more than a piece holds

void write_file(const Ranks& ranks, const std::string& path, int compression, bool collective) {
  const RowStorage storage{20, 4096, true, compression};
  ranks.on_root([&] {
    Hdf5File file(path, Hdf5Access::create);
    file.create_rows<std::int64_t>("/wide", storage, {"1", "values"});
    file.create_rows<Real>("/narrow", {1, 1000, true, compression}, {"1", "values"});
    for (const char* name : {"/wide", "/narrow"}) file.resize_rows(name, kRows);
    file.close();
  });
  SharedRows file(ranks, path, collective);
  const RowPart own = uneven_part(kRows, ranks.rank(), ranks.size());
  std::vector<std::int64_t> piece;
  file.write_pieces<std::int64_t>("/wide", storage.width, own, [&](std::int64_t first, std::int64_t count) {
    piece.clear();
    for (std::int64_t k = 0; k < count * storage.width; ++k)
      piece.push_back(value_of((own.first + first) * storage.width + k));
    return piece.data();
  });
  std::vector<Real> values;
  for (std::int64_t k = 0; k < own.count; ++k)
    values.push_back(static_cast<Real>(value_of(own.first + k)) / 3);
  file.write("/narrow", 1, own, values.data());
  file.close();
}

bool holds_the_values(const std::string& path) {
  const Hdf5File file(path, Hdf5Access::read);
  const auto wide = file.read_array<std::int64_t>("/wide");
  const auto narrow = file.read_array<Real>("/narrow");
  bool right = std::ssize(wide) == 20 * kRows && std::ssize(narrow) == kRows;
  for (std::size_t k = 0; right && k < wide.size(); ++k)
    right = wide[k] == value_of(static_cast<std::int64_t>(k));
  for (std::size_t k = 0; right && k < narrow.size(); ++k)
    right = narrow[k] == static_cast<Real>(value_of(static_cast<std::int64_t>(k))) / 3;
  return right;
}

// The message that all ranks throw; empty if none. CHECKs that it is the same on all.
std::string common_failure(const Ranks& ranks, const std::function<void()>& action) {
  std::string message;
  try {
    action();
  } catch (const IoError& error) {
    message = error.what();
  }
  std::vector<char> all = ranks.all_gather(std::vector<char>(message.begin(), message.end()));
  std::string expected;
  for (int r = 0; r < ranks.size(); ++r) expected += message;
  CHECK(std::string(all.begin(), all.end()) == expected);
  return message;
}

}  // namespace

TEST_CASE("every id has one owner, and ranges cover the ids without a gap") {
  for (const std::int64_t count : {0, 1, 5, 12, 1000003})
    for (const int size : {1, 2, 3, 7, 12}) {
      GlobalId next = 0;
      for (int r = 0; r < size; ++r) {
        const IdRange range = id_range(count, r, size);
        REQUIRE(range.first == next);
        next = range.last;
        if (range.size() == 0) continue;
        CHECK((id_owner(count, range.first, size) == r && id_owner(count, range.last - 1, size) == r));
      }
      REQUIRE(next == count);
    }
  constexpr std::int64_t kHuge = std::int64_t{1} << 62;
  CHECK(id_range(kHuge, 1023, 1024).last == kHuge);
  CHECK(id_owner(kHuge, kHuge - 1, 1000) == 999);
}

TEST_CASE("values find the ranks that write them, in the order of the ids") {
  const Ranks ranks = world();
  constexpr std::int64_t kCount = 1000;
  // Every third particle is missing; the others are distributed without order.
  std::vector<GlobalId> ids;
  for (GlobalId k = 0; k < kCount; ++k) {
    const GlobalId id = k * 617 % kCount;
    if (id % 3 != 0 && k % ranks.size() == ranks.rank()) ids.push_back(id);
  }
  const IdOrder order(ranks, kCount, ids);
  std::vector<Vec3> places;
  for (const GlobalId id : ids) places.push_back({static_cast<Real>(id), 1, -2});
  const std::vector<GlobalId> sorted = order.apply(ids);
  const std::vector<Vec3> moved = order.apply(std::move(places));
  std::vector<GlobalId> expected;
  const IdRange own = id_range(kCount, ranks.rank(), ranks.size());
  for (GlobalId id = own.first; id < own.last; ++id)
    if (id % 3 != 0) expected.push_back(id);
  CHECK(sorted == expected);
  REQUIRE(moved.size() == expected.size());
  for (std::size_t i = 0; i < moved.size(); ++i) REQUIRE(moved[i].x == static_cast<Real>(expected[i]));
}

TEST_CASE("an exception of one rank is thrown on every rank") {
  const Ranks ranks = world();
  const int last = ranks.size() - 1;
  CHECK(common_failure(ranks, [&] { ranks.collectively([] {}); }).empty());
  CHECK(common_failure(ranks, [&] {
          ranks.collectively([&] {
            if (ranks.rank() == last) throw IoError("from the last");
          });
        }) == "from the last");
  CHECK(common_failure(ranks, [&] {
          ranks.collectively([&] { throw IoError("from " + std::to_string(ranks.rank())); });
        }) == "from 0");
}

TEST_CASE("rows are the same, written by all ranks at once or through rank 0, compressed or not") {
  const Ranks ranks = world();
  const SharedFolder folder(ranks);
  std::uintmax_t plain = 0;
  for (const bool collective : {kParallelHdf5, false})
    for (const int compression : {0, 4}) {
      CAPTURE(collective, compression);
      write_file(ranks, folder / "rows.h5", compression, collective);
      CHECK(holds_the_values(folder / "rows.h5"));
      const std::uintmax_t size = std::filesystem::file_size(folder / "rows.h5");
      if (compression == 0) plain = size;
      if (compression > 0) CHECK(size < 3 * plain / 4);
      ranks.any(false);  // all have read it
    }
}

TEST_CASE("a checkpoint of several ranks returns in equal parts") {
  const Ranks ranks = world();
  const SharedFolder folder(ranks);
  const RowPart own = uneven_part(1001, ranks.rank(), ranks.size());
  Checkpoint checkpoint;
  checkpoint.reals["time"] = {0.5};
  checkpoint.integer_rows["some/rows"] = {3, own.count,
                                          [&](std::int64_t first, std::int64_t count, std::int64_t* to) {
                                            for (std::int64_t k = 0; k < 3 * count; ++k)
                                              to[k] = 3 * (own.first + first) + k;
                                          }};
  for (const int compression : {0, 1}) {
    write_checkpoint(folder / "c.h5", checkpoint, ranks, compression);
    const Checkpoint read = with_rows_as_arrays(read_checkpoint(folder / "c.h5", ranks));
    const IdRange part = id_range(1001, ranks.rank(), ranks.size());
    std::vector<std::int64_t> expected(static_cast<std::size_t>(3 * part.size()));
    std::iota(expected.begin(), expected.end(), 3 * part.first);
    CHECK(read.integer_array("some/rows") == expected);
    CHECK(read.real_array("time") == std::vector<Real>{0.5});
    ranks.any(false);
  }
}

TEST_CASE("snapshots of several ranks read back as those of one") {
  const Ranks ranks = world();
  for (const int compression : {0, 1}) {
    const SharedFolder folder(ranks);
    const std::vector<int> counts = {5, 5, 1000, 0, 300, 300};
    {
      SnapshotWriter writer(folder.path(), {"title", 0, compression, ranks});
      for (const int n : counts) {
        const PredictableSnapshot whole(writer.snapshots(), n, ranks.is_root() ? 2 : 0);
        const RowPart own = uneven_part(n, ranks.rank(), ranks.size());
        writer.append(
            whole.time,
            whole.particles(static_cast<std::size_t>(own.first), static_cast<std::size_t>(own.count)),
            whole.bodies());
      }
    }
    CHECK(read_predictable_particles(folder / "particles.vtkhdf") == counts);
    CHECK(Hdf5File(folder / "bodies.vtkhdf", Hdf5Access::read).rows("/VTKHDF/Points") == 12);
    // A restart that keeps some of them continues on all ranks.
    SnapshotWriter again(folder.path(), {"title", 2, compression, ranks});
    again.append(0.5, {}, {});
    CHECK(again.snapshots() == 3);
    CHECK(read_predictable_particles(folder / "particles.vtkhdf") == std::vector<int>{5, 5, 0});
  }
}

// A file that cannot grow, as on a full disk: on rank 0, on all ranks, or on all but rank 0, where it
// depends on the MPI library which ranks write.
TEST_CASE("a write that fails on one rank fails on all, with its message, and leaves what was there") {
  const Ranks ranks = world();
  const SharedFolder folder(ranks);
  const FileSizeLimit limit;
  constexpr std::int64_t kEach = 200000;
  const auto write = [&](int value) {
    Checkpoint checkpoint;
    checkpoint.integer_rows["rows"] = {1, kEach, [=](std::int64_t, std::int64_t count, std::int64_t* to) {
                                         std::fill(to, to + count, value);
                                       }};
    write_checkpoint(folder / "c.h5", checkpoint, ranks);
  };
  const auto holds = [&](int value) {
    const Checkpoint read = with_rows_as_arrays(read_checkpoint(folder / "c.h5"));
    return read.integer_array("rows") ==
           std::vector<std::int64_t>(static_cast<std::size_t>(kEach * ranks.size()), value);
  };
  write(1);
  enum { kRoot, kAll, kOthers };
  for (const int limited : {kRoot, kAll, kOthers}) {
    CAPTURE(limited);
    if (limited == kAll || (limited == kRoot) == ranks.is_root()) limit.set(400000);
    const std::string message = common_failure(ranks, [&] { write(2); });
    limit.lift();
    if (limited != kOthers) CHECK(message.find("c.h5.tmp: cannot") != std::string::npos);
    CHECK(holds(message.empty() ? 2 : 1));
    CHECK(!std::filesystem::exists(folder / "c.h5.tmp"));
    ranks.any(false);  // all have read it
  }
}

// The disk fills up while the rows are written, which the library, MPI and the system may all fail to
// report: a file that cannot grow takes the beginning of a write.
TEST_CASE("rows that only partly get to the disk do not replace a good checkpoint") {
  const Ranks ranks = world();
  const SharedFolder folder(ranks);
  const FileSizeLimit limit;
  constexpr std::int64_t kEach = 50001;
  const auto value = [&](std::int64_t row, std::uint64_t seed) {  // nearly incompressible
    const auto mixed = (static_cast<std::uint64_t>(ranks.rank() * kEach + row) + seed) * 0x9e3779b97f4a7c15u;
    return static_cast<std::int64_t>(mixed ^ (mixed >> 29));
  };
  const auto write = [&](std::uint64_t seed, int compression, rlim_t most) {
    Checkpoint checkpoint;
    checkpoint.integer_rows["rows"] = {1, kEach,
                                       [&](std::int64_t first, std::int64_t count, std::int64_t* to) {
                                         for (std::int64_t k = 0; k < count; ++k)
                                           to[k] = value(first + k, seed);
                                         limit.set(most);
                                       }};
    const std::string message =
        common_failure(ranks, [&] { write_checkpoint(folder / "c.h5", checkpoint, ranks, compression); });
    limit.lift();
    return message;
  };
  const auto holds = [&](std::uint64_t seed) {
    const Checkpoint read = with_rows_as_arrays(read_checkpoint(folder / "c.h5", ranks));
    const std::vector<std::int64_t>& rows = read.integer_array("rows");
    bool right = std::ssize(rows) == kEach;
    for (std::size_t k = 0; right && k < rows.size(); ++k)
      right = rows[k] == value(static_cast<std::int64_t>(k), seed);
    return !ranks.any(!right);
  };
  for (const int compression : {0, 1}) {
    CAPTURE(compression);
    REQUIRE(write(1, compression, FileSizeLimit::kNone).empty());
    REQUIRE(holds(1));
    const auto bytes = static_cast<rlim_t>(kEach * ranks.size() * 8);
    for (const rlim_t most : {bytes / 7, bytes / 3, bytes / 2, compression == 0 ? bytes - 9 : bytes / 100}) {
      CAPTURE(most);
      reservation_error = EOPNOTSUPP;
      CHECK(write(2, compression, most).find("c.h5.tmp: cannot") != std::string::npos);
      reservation_error = 0;
      CHECK(holds(1));
      CHECK(!std::filesystem::exists(folder / "c.h5.tmp"));
      ranks.any(false);  // all have looked
    }
  }
  REQUIRE(write(1, 0, FileSizeLimit::kNone).empty());
  reservation_error = ENOSPC;
  CHECK(write(2, 0, FileSizeLimit::kNone).find("c.h5.tmp: cannot reserve its disk space: No space left") !=
        std::string::npos);
  reservation_error = EOPNOTSUPP;
  CHECK(write(3, 0, FileSizeLimit::kNone).empty());
  reservation_error = 0;
  CHECK(holds(3));
}

TEST_CASE("a state that no run can have written is refused on every rank") {
  const Ranks ranks = world();
  constexpr std::int64_t kParticles = 1000;  // of which every fifth is missing
  ParticleSet deck;
  deck.totals.at_start = kParticles;
  State good;
  good.carried_out.removed = kParticles / 5;
  const IdRange own = id_range(kParticles, ranks.rank(), ranks.size());
  for (GlobalId id = own.first; id < own.last; ++id)
    if (id % 5 != 0) good.particles.emplace_back().global_id = id;
  const auto refusal = [&](const std::function<void(State&)>& spoil) {
    State state = good;
    spoil(state);
    const std::string message = common_failure(ranks, [&] { check_state(state, "some.h5", deck, ranks); });
    CHECK((message.empty() || message.starts_with("some.h5: not a valid checkpoint: ")));
    return message;
  };
  const bool last = ranks.rank() == ranks.size() - 1;
  const auto refused = [&](const std::string& words, const std::function<void(State&)>& spoil) {
    CAPTURE(words);
    CHECK(refusal([&](State& s) {
            if (last) spoil(s);
          }).find(words) != std::string::npos);
  };
  CHECK(refusal([](State&) {}).empty());
  refused("particle id -1;", [](State& s) { s.particles[0].global_id = -1; });
  refused("particle id 1000;", [](State& s) { s.particles.back().global_id = kParticles; });
  refused("ids must increase", [](State& s) { s.particles[9].global_id = s.particles[8].global_id; });
  refused("ids must increase", [](State& s) { std::swap(s.particles[9], s.particles[8]); });
  refused("is not finite", [](State& s) { s.particles[7].integrator_loss = std::nan(""); });
  refused("is not finite", [](State& s) { s.particles[7].position.z = -INFINITY; });
  refused("799 particles", [](State& s) { s.particles.pop_back(); });
  refused("'bodies/velocity' is not finite", [](State& s) { s.bodies.velocity = {1, std::nan("")}; });
  if (ranks.size() > 1)  // from rank to rank
    refused("ids must increase", [](State& s) { s.particles[0].global_id = 1; });
}

}  // namespace scree
