// A row of triangles queried by several threads together.
#include "mesh/lane_group.hpp"

#include <array>
#include <barrier>
#include <thread>

#include "mesh/cached_contact.hpp"
#include "support/catch.hpp"
#include "support/test_meshes.hpp"

namespace scree {

namespace {

constexpr int kLanes = 4;
constexpr Real kRadius = 0.1;

// Threads in the place of a GPU's lanes.
class ThreadLane {
 public:
  struct Shared {
    std::barrier<> all{kLanes};
    std::array<const void*, kLanes> value{};
  };
  ThreadLane(Shared& shared, int lane) : shared_(&shared), lane_(lane) {}

  Index first() const { return lane_; }
  static constexpr Index stride() { return kLanes; }
  template <class T, class Merge>
  T reduce(T value, const Merge& merge) const {
    for (int across = kLanes / 2; across > 0; across /= 2) {
      shared_->value[static_cast<std::size_t>(lane_)] = &value;
      shared_->all.arrive_and_wait();
      const T other = *static_cast<const T*>(shared_->value[static_cast<std::size_t>(lane_ ^ across)]);
      shared_->all.arrive_and_wait();
      value = merge(value, other);
    }
    return value;
  }

 private:
  Shared* shared_;
  int lane_;
};

struct Queried {
  Nearest found;
  std::uint64_t chosen = 0;
  MeshContact contact{-1, -1, 0, {}, {}};
  CachedContact cached = kNoCachedContact;

  friend bool operator==(const Queried& a, const Queried& b) {
    return a.found == b.found && a.chosen == b.chosen &&
           (a.found != Nearest::one || same_contacts({a.contact}, {b.contact})) &&
           a.cached.safe_distance == b.cached.safe_distance && a.cached.triangle == b.cached.triangle;
  }
};

struct Place {
  Vec3 c;
  std::vector<Index> row;
};

template <class LaneGroup>
std::vector<Queried> queries(const MeshView& view, const std::vector<Place>& positions,
                             const LaneGroup& team) {
  std::vector<Queried> all;
  for (const Place& at : positions) {
    const auto n = static_cast<Index>(at.row.size());
    const RowKind kind = kind_of_row(view, at.row.data(), n);
    Queried query{};
    query.found = NearestContact(view, at.c, kRadius, kind).find({at.row.data(), n}, team, query.contact);
    if (query.found == Nearest::unclear)
      query.chosen = with_contacts_only(view, at.c, kRadius, {at.row.data(), n}, team).chosen;
    const CachedContactRow<LaneGroup> row{view, kind, at.row.data(), n, at.c, kRadius, team};
    if (query.found == Nearest::none) query.cached = row.clear();
    if (query.found == Nearest::one && query.contact.feature < view.part_count)
      query.cached = row.over(query.contact.triangle);
    all.push_back(query);
  }
  return all;
}

}  // namespace

TEST_CASE("a team finds at the triangles of a row what one alone does, and all of it the same") {
  MeshRandom random(50);
  int touching = 0, unclear = 0;
  for (const SurfaceMesh& surface :
       {sheet_mesh(hills(12, 0.005, 2)), sheet_mesh(hills(6, 2, 3)), closed_mesh(drum_shell(60, 0.5, 1, 3)),
        closed_mesh(potato(4, 0.002, 5)), closed_mesh(block({0, 0, 0}, {1, 1, 1}, 6))}) {
    const MeshView view = surface.view();
    std::vector<Place> positions;
    while (positions.size() < 2000) {
      const Vec3 c = position_near(surface, 1.2 * kRadius, random);
      positions.push_back({c, triangles_near(surface, c, 1.2 * kRadius)});
    }
    ThreadLane::Shared shared;
    std::array<std::vector<Queried>, kLanes> of_lane;
    std::vector<std::thread> threads;
    for (int lane = 0; lane < kLanes; ++lane)
      threads.emplace_back([&, lane] {
        of_lane[static_cast<std::size_t>(lane)] = queries(view, positions, ThreadLane(shared, lane));
      });
    for (std::thread& thread : threads) thread.join();
    const std::vector<Queried> alone = queries(view, positions, SingleLane{});
    for (const std::vector<Queried>& of_one : of_lane) CHECK(of_one == alone);
    for (const Queried& query : alone)
      touching += query.found == Nearest::one, unclear += query.found == Nearest::unclear;
  }
  CHECK(touching > 1000);
  CHECK(unclear > 0);
}

}  // namespace scree
