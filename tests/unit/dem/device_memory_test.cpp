// Whether the ranks that share a GPU fit into its memory.
#include "dem/backend/device.hpp"
#include "dem/host/host_surfaces.hpp"
#include "dem/search/neighbor_list.hpp"
#include "mesh/cached_contact.hpp"
#include "support/catch.hpp"
#include "unit/dem/random_box.hpp"

namespace scree {

namespace {

constexpr std::size_t kMegabyte = 1000000;

DeviceClaim claim(char device, std::size_t needed, std::size_t free) {
  return {{device}, needed * kMegabyte, free * kMegabyte};
}

Model model_with_floor(int particles, int squares, Real height = 0) {
  Model model = random_box(kBoxes[6], particles, 5);
  if (squares > 0) add_floor(model, squares), model.walls.back().point.z = height;
  return model;
}

double memory_with_floor(int particles, int squares, Real height = 0) {
  return static_cast<double>(device_memory(model_with_floor(particles, squares, height)));
}

SurfaceRows rows_at_start(const Model& model) {
  const Subdomain subdomain(model.space);
  HostSurfaces surfaces(model, subdomain, Ranks());
  surfaces.set_motion(std::vector<BodyMotion>(surfaces.surfaces().parents()));
  surfaces.bring_into_box(), surfaces.update_poses();
  ParticleStore store;
  store.load(initial_records(model.particles, subdomain));
  ItemLayout layout;
  layout.owned = layout.active = layout.items = store.owned;
  NeighborBuilder builder(model);
  SurfaceRows rows;
  builder.build_surfaces(store, layout, builder.cells(model.contact.skin, layout.owned), {surfaces.poses()},
                         model.contact.skin, rows);
  return rows;
}

}  // namespace

TEST_CASE("device memory has meshes with their trees, and the rows of those that are near them") {
  const double few = memory_with_floor(0, 20), many = memory_with_floor(0, 40),
               more = memory_with_floor(0, 80);
  const double per_triangle = (more - many) / (2 * 60 * 80);
  CHECK((per_triangle > sizeof(MeshTriangle) + 3 * sizeof(MeshFeature) / 2 && per_triangle < 400));
  CHECK(near((more - many) / (many - few), 4, {.relative = 0.05}));
  CHECK(few - memory_with_floor(0, 0) >= 800 * per_triangle);

  const double close = memory_with_floor(500, 20), away = memory_with_floor(500, 20, 10);
  CHECK(away > memory_with_floor(500, 0));
  CHECK(close - away > 500 * 0.1 / 1.3 * sizeof(SurfaceLoad));  // those whose centres are half a radius away
}

TEST_CASE("device memory of meshes is that of their arrays") {
  Model model = random_box(kBoxes[6], 100, 5);
  add_floor(model, 7), add_floor(model, 30);
  const auto bytes = [](const auto&... arrays) { return ((arrays.size() * sizeof(arrays.front())) + ...); };
  std::size_t expected = 0;
  for (const ModelMesh& mesh : model.meshes) {
    const SurfaceMesh& m = *mesh.surface;
    expected += sizeof(MeshView) + bytes(m.vertices, m.triangles, m.parts, m.features, m.tests, m.patches,
                                         m.first_neighbour, m.neighbours, m.boxes);
  }
  CHECK(device_memory_of_meshes(model) == expected);
}

TEST_CASE("particles near a mesh take the device memory of their entries, groups and triangles") {
  const Model model = model_with_floor(500, 20), away = model_with_floor(500, 20, 10);
  const SurfaceRows rows = rows_at_start(model), rows_away = rows_at_start(away);
  const double groups = static_cast<double>(rows.groups.size()),
               triangles = static_cast<double>(rows.triangles.size()),
               entries = static_cast<double>(rows.surfaces.size() - rows_away.surfaces.size());
  REQUIRE(rows_away.groups.empty());  // its entries are those of planes
  REQUIRE((groups > 38 && entries >= groups && triangles > groups));
  constexpr double kSpare = 1.125, kGroup = sizeof(MeshGroup) + sizeof(CachedContact) + 3 * sizeof(Index),
                   kTriangle = sizeof(Index);
  const double of_group = kSpare * (kGroup + 10 * kTriangle),
               of_entry = static_cast<double>(device_memory_near_mesh(model)) - of_group;
  CHECK(of_entry > 2 * sizeof(SurfaceLoad) + sizeof(SurfaceStep) + sizeof(MeshTouch));
  const double near_mesh = static_cast<double>(device_memory(model) - device_memory(away));
  CHECK(near(near_mesh, of_entry * entries + kSpare * (kGroup * groups + kTriangle * triangles),
             {.relative = 0.01}));
}

TEST_CASE("device memory counts meshes without contacts, and reports their part") {
  Model model = random_box(kBoxes[6], 100, 5);
  const std::size_t without = device_memory(model);
  CHECK(device_memory_of_meshes(model) == 0);
  add_floor(model, 50);
  model.walls.pop_back();
  const SurfaceMesh& mesh = *model.meshes.back().surface;
  const std::size_t meshes = device_memory_of_meshes(model);
  CHECK(near(device_memory(model) - without, meshes, {.absolute = 1}));
  CHECK(meshes > mesh.triangles.size() * sizeof(MeshTriangle) + mesh.vertices.size() * sizeof(Vec3) +
                     mesh.features.size() * sizeof(MeshFeature) + mesh.boxes.size() * sizeof(MeshBox));
}

TEST_CASE("a rank with a GPU of its own is judged by its own need") {
  const DeviceClaim claims[] = {claim('a', 300, 300), claim('b', 301, 300), claim('c', 1, 300)};
  CHECK(device_memory_trouble(claims, 0, "GPU") == "");
  CHECK(device_memory_trouble(claims, 1, "GPU") ==
        "the model needs about 301 MB of device memory, 300 MB are free on GPU");
  CHECK(device_memory_trouble(claims, 2, "GPU") == "");
}

TEST_CASE("the needs of ranks that share a GPU add up") {
  // Three ranks on a, two on b, in turn.
  const DeviceClaim claims[] = {claim('a', 200, 500), claim('b', 200, 500), claim('a', 150, 500),
                                claim('b', 300, 500), claim('a', 151, 500)};
  for (const int own : {0, 2, 4})
    CHECK(device_memory_trouble(claims, own, "GPU") ==
          "3 ranks share a GPU and together need about 501 MB of device memory, 500 MB are free on GPU");
  for (const int own : {1, 3}) CHECK(device_memory_trouble(claims, own, "GPU") == "");
}

TEST_CASE("the load of a GPU is that of all ranks that use it") {
  const DeviceClaim claims[] = {claim('a', 200, 500), claim('b', 100, 300), claim('a', 150, 400)};
  const DeviceLoad shared = load_of_device(claims, 2), single = load_of_device(claims, 1);
  CHECK((shared.ranks == 2 && shared.needed == 350 * kMegabyte && shared.free == 400 * kMegabyte));
  CHECK((single.ranks == 1 && single.needed == 100 * kMegabyte && single.free == 300 * kMegabyte));
}

TEST_CASE("ranks of a GPU agree on what is free: the least that one of them saw") {
  const DeviceClaim claims[] = {claim('a', 200, 450), claim('a', 200, 390)};
  for (const int own : {0, 1})
    CHECK(device_memory_trouble(claims, own, "GPU") ==
          "2 ranks share a GPU and together need about 400 MB of device memory, 390 MB are free on GPU");
}

}  // namespace scree
