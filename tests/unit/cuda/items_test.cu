// The items of src/dem on the device against the same items on the CPU. Both are built without contraction,
// and roots and divisions are exact to the last bit on both: the results must be equal bit for bit.
#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

#include "contact_kernels.cuh"
#include "dem/neighbor_list.hpp"
#include "step_kernels.cuh"
#include "support/catch.hpp"

namespace scree {
namespace {

// A copy of a host array on the device, freed with the object.
template <class T>
class DeviceArray {
 public:
  explicit DeviceArray(const std::vector<T>& host) : size_(host.size()) {
    require_cuda(cudaMalloc(&data_, std::max<std::size_t>(size_, 1) * sizeof(T)), "cudaMalloc");
    require_cuda(cudaMemcpy(data_, host.data(), size_ * sizeof(T), cudaMemcpyHostToDevice), "cudaMemcpy");
  }
  explicit DeviceArray(std::size_t size) : DeviceArray(std::vector<T>(size)) {}
  ~DeviceArray() { cudaFree(data_); }
  DeviceArray(const DeviceArray&) = delete;
  DeviceArray& operator=(const DeviceArray&) = delete;

  T* get() const { return data_; }
  std::vector<T> host() const {
    std::vector<T> out(size_);
    require_cuda(cudaMemcpy(out.data(), data_, size_ * sizeof(T), cudaMemcpyDeviceToHost), "cudaMemcpy");
    return out;
  }

 private:
  std::size_t size_;
  T* data_ = nullptr;
};

template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

// Spheres of several radii in a box with a floor, dense enough that most touch.
Model random_model(Index n, Real exponent, bool tension) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<Real> unit(0, 1);
  Model model;
  model.space.min = {0, 0, 0}, model.space.max = {2, 2, 2};
  model.contact.material_names = {"sphere"};
  model.contact.laws = {{1e6, 50, exponent, tension}};
  model.contact.skin = 0.01;
  model.walls = {{"floor", {0, 0, 0}, {0, 1, 0}, 0}};
  for (Index i = 0; i < n; ++i) {
    const Real radius = 0.03 + 0.02 * unit(engine);
    model.particles.position.push_back({2 * unit(engine), 2 * unit(engine), 2 * unit(engine)});
    model.particles.velocity.push_back({unit(engine) - 0.5, unit(engine) - 0.5, unit(engine) - 0.5});
    model.particles.radius.push_back(radius);
    model.particles.mass.push_back(4000 * radius * radius * radius);
    model.particles.material.push_back(0);
  }
  return model;
}

// Host arrays of one configuration, and the views of the copies on the device.
struct Scene {
  explicit Scene(const Model& model) : shapes(model) {
    store.load(model.particles, initial_records(model.particles, Subdomain(model.space)));
    layout.owned = layout.active = layout.first_shape = layout.items = store.owned;
    NeighborBuilder(model, shapes).build(store, layout, model.contact.skin, list);
    for (const Wall& wall : model.walls) planes.push_back({wall.point, wall.normal, wall.material});
  }
  ContactViews views() const {
    return {store.position.data(), store.velocity.data(), store.material.data(),
            list.offsets.data(),   list.neighbors.data(), list.wall_offsets.data(),
            list.walls.data(),     planes.data(),         layout.first_shape};
  }

  BodyShapes shapes;
  ParticleStore store;
  ItemLayout layout;
  NeighborList list;
  std::vector<WallPlane> planes;
};

struct DeviceScene {
  explicit DeviceScene(const Scene& s)
      : position(s.store.position),
        velocity(s.store.velocity),
        material(s.store.material),
        offsets(s.list.offsets),
        neighbors(s.list.neighbors),
        wall_offsets(s.list.wall_offsets),
        walls(s.list.walls),
        planes(s.planes),
        first_shape(s.layout.first_shape) {}
  ContactViews views() const {
    return {position.get(),     velocity.get(), material.get(), offsets.get(), neighbors.get(),
            wall_offsets.get(), walls.get(),    planes.get(),   first_shape};
  }

  DeviceArray<Vec4> position, velocity;
  DeviceArray<int> material;
  DeviceArray<Index> offsets, neighbors, wall_offsets, walls;
  DeviceArray<WallPlane> planes;
  Index first_shape;
};

const Vec3 kGravity{0, -9.8066, 0};

}  // namespace

TEST_CASE("contact forces on the device equal the CPU's bit for bit") {
  for (const bool tension : {true, false}) {
    const Model model = random_model(20000, 1, tension);
    const Scene scene(model);
    const std::size_t n = model.particles.size();
    std::vector<Vec3> force(n);
    std::vector<Real> loss(n);
    make_contact_kernels(model.contact)
        ->forces(scene.views(), kGravity, scene.layout.owned, force.data(), loss.data());

    const DeviceScene device(scene);
    const DeviceArray<Vec3> d_force(n);
    const DeviceArray<Real> d_loss(n);
    const DeviceContactKernels<LinearElastic, OneLaw> kernels(Device{}, {model.contact.laws[0]});
    kernels.forces(device.views(), kGravity, scene.layout.owned, d_force.get(), d_loss.get());
    CAPTURE(tension);
    CHECK(scene.list.neighbors.size() > 5 * n);
    CHECK(same_bits(d_force.host(), force));
    CHECK(same_bits(d_loss.host(), loss));
  }
}

TEST_CASE("an implicit step's system on the device equals the CPU's bit for bit") {
  const Model model = random_model(20000, 1, false);
  Scene scene(model);
  const std::size_t n = model.particles.size(), slots = scene.list.neighbors.size();
  // The step started a little earlier: contacts open and close within it.
  std::vector<Vec4> start = scene.store.position;
  const Real h = 1e-3;
  for (std::size_t i = 0; i < n; ++i)
    start[i] = vec4(xyz(start[i]) - h * xyz(scene.store.velocity[i]), start[i].w);
  const NewtonWeights weights{h * h / 4, h / 2};

  std::vector<Vec3> step(n), end(n), b(slots);
  std::vector<Real> step_loss(n), end_loss(n), magnitude(n);
  std::vector<Index> count(n), neighbor(slots);
  std::vector<Sym3> diagonal(n);
  make_contact_kernels(model.contact)
      ->system(scene.views(), kGravity, scene.layout.owned, weights,
               {start.data(), scene.store.velocity.data(), h, true},
               {step.data(), end.data(), step_loss.data(), end_loss.data(), magnitude.data()},
               {count.data(), neighbor.data(), b.data(), diagonal.data()});

  const DeviceScene device(scene);
  const DeviceArray<Vec4> d_start(start);
  const DeviceArray<Vec3> d_step(n), d_end(n), d_b(slots);
  const DeviceArray<Real> d_step_loss(n), d_end_loss(n), d_magnitude(n);
  const DeviceArray<Index> d_count(n), d_neighbor(slots);
  const DeviceArray<Sym3> d_diagonal(n);
  const DeviceContactKernels<LinearElastic, OneLaw> kernels(Device{}, {model.contact.laws[0]});
  kernels.system(device.views(), kGravity, scene.layout.owned, weights,
                 {d_start.get(), device.velocity.get(), h, true},
                 {d_step.get(), d_end.get(), d_step_loss.get(), d_end_loss.get(), d_magnitude.get()},
                 {d_count.get(), d_neighbor.get(), d_b.get(), d_diagonal.get()});
  CHECK(same_bits(d_step.host(), step));
  CHECK(same_bits(d_end.host(), end));
  CHECK(same_bits(d_step_loss.host(), step_loss));
  CHECK(same_bits(d_magnitude.host(), magnitude));
  CHECK(same_bits(d_count.host(), count));
  CHECK(same_bits(d_neighbor.host(), neighbor));
  CHECK(same_bits(d_b.host(), b));
  CHECK(same_bits(d_diagonal.host(), diagonal));
}

TEST_CASE("velocity-Verlet steps on the device equal the CPU's bit for bit") {
  const Model model = random_model(20000, 1, false);
  Scene scene(model);
  const std::size_t n = model.particles.size();
  const DeviceScene device(scene);
  const DeviceArray<Vec4> d_position(scene.store.position), d_velocity(scene.store.velocity);
  const DeviceArray<Vec3> d_acceleration(scene.store.acceleration);
  const DeviceArray<Real> d_loss(scene.store.contact_loss), d_power(scene.store.loss_power), d_squared(1);

  std::vector<Vec4> position(n), velocity(n);
  const Real squared = make_contact_kernels(model.contact)
                           ->verlet_advance(scene.views(), kGravity, scene.layout.owned,
                                            {position.data(),
                                             velocity.data(),
                                             scene.store.acceleration.data(),
                                             scene.store.contact_loss.data(),
                                             scene.store.loss_power.data(),
                                             1e-5,
                                             {}});
  const DeviceContactKernels<LinearElastic, OneLaw> kernels(Device{}, {model.contact.laws[0]});
  kernels.verlet_advance(
      device.views(), kGravity, scene.layout.owned,
      {d_position.get(), d_velocity.get(), d_acceleration.get(), d_loss.get(), d_power.get(), 1e-5, {}},
      d_squared.get());
  CHECK(same_bits(d_position.host(), position));
  CHECK(same_bits(d_velocity.host(), velocity));
  CHECK(same_bits(d_acceleration.host(), scene.store.acceleration));
  CHECK(same_bits(d_loss.host(), scene.store.contact_loss));
  CHECK(d_squared.host()[0] == squared);
}

}  // namespace scree
