// Friction of particles on the GPU against the CPU: bit for bit, with and without pruned rows and with
// either form of the step's kernel, and from one backend to the other.
#include "launches.hpp"
#include "support/catch.hpp"
#include "support/contact_line_bits.hpp"
#include "support/contact_record.hpp"
#include "support/frictional_box.hpp"
#include "support/particle_bits.hpp"

namespace scree {
namespace {

std::unique_ptr<Backend> make_cpu(const Model& model, const Ranks& ranks) {
  return make_cpu_backend(model, ranks);
}
std::unique_ptr<Backend> make_cuda(const Model& model, const Ranks& ranks) {
  return make_cuda_backend(model, ranks);
}

void check_equal(const FrictionalBoxKind& kind, const HistoryTestBox& cpu, const HistoryTestBox& cuda) {
  const State a = cpu.state(), b = cuda.state();
  CHECK(differing_fields(a.particles, b.particles) == "");
  CHECK(difference(a.contacts, b.contacts) == "");
  CHECK(!a.contacts.keys.empty());
  CHECK(kind.unmirrored(b.particles, b.contacts) == 0);
  const std::int64_t particles = cpu.model.particles.totals.count;
  CHECK(same_bits(ordered_lines(cpu.backend->reports(), particles),
                  ordered_lines(cuda.backend->reports(), particles)));
}

// Compares the ledgers of both backends.
void check_ledgers(const HistoryTestBox& cpu, const HistoryTestBox& cuda) {
  const ParticleLedger a = cpu.backend->reports().ledger(kMovingStep),
                       b = cuda.backend->reports().ledger(kMovingStep);
  CHECK(a.contacts == b.contacts);
  CHECK(a.kinetic == b.kinetic);
  CHECK(a.contact_elastic == b.contact_elastic);
  CHECK(a.contact_loss == b.contact_loss);
  CHECK(a.angular_momentum == b.angular_momentum);
  CHECK(a.rotation == b.rotation);
  CHECK(a.cohesion == b.cohesion);
}

// Separate spheres that slide down a plane under their weight.
Model sliding_box(const BoxCase& c) {
  Model model = random_box(c, 5, 33);
  const Vec3 normal = model.walls[0].normal, down{normal.y, -normal.x, 0};
  ParticleSet& set = model.particles;
  for (std::size_t i = 0; i < set.size(); ++i) {
    const Real overlap = -set.mass[i] * dot(model.gravity, normal) / model.contact.laws[0].normal_stiffness;
    set.position[i] = model.walls[0].point + (set.radius[i] - overlap) * normal - Real(0.5) * down;
    set.position[i].z = model.space.min.z + kLargestRadius * (1 + 2.4 * static_cast<Real>(i));
    set.velocity[i] = (1 + 0.1 * static_cast<Real>(i)) * down;
  }
  return model;
}

}  // namespace

TEST_CASE("friction is the same on both backends, and each continues from the other's state") {
  for (const FrictionalBoxKind& kind : kFrictionalBoxKinds)
    for (const auto& [c, leaving] : moving_cases()) {
      CAPTURE(kind.name, c.name, static_cast<int>(leaving));
      const Model model = kind.of(moving_frictional_box(c, leaving));
      HistoryTestBox cpu(model, {}, make_cpu), cuda(model, {}, make_cuda);
      for (HistoryTestBox* box : {&cpu, &cuda}) box->start();
      for (int part = 0; part < 20; ++part) {
        for (HistoryTestBox* box : {&cpu, &cuda}) box->take_steps(50);
        check_equal(kind, cpu, cuda), check_ledgers(cpu, cuda);
      }
      CHECK(cuda.backend->reports().ledger(kMovingStep).rotation.losses.of[kFrictionLoss] > 0);
      HistoryTestBox on_cpu(model, {}, make_cpu), on_cuda(model, {}, make_cuda);
      on_cpu.motion = on_cuda.motion = cpu.motion;
      on_cpu.start(cuda.state()), on_cuda.start(cpu.state());
      for (HistoryTestBox* box : {&on_cpu, &on_cuda, &cpu}) box->take_steps(100);
      check_equal(kind, on_cpu, on_cuda), check_equal(kind, cpu, on_cuda);
    }
}

// Without and with lagged friction limits.
TEST_CASE("friction is the same on both backends in implicit steps") {
  for (const BoxCase& c : kFrictionalBoxes)
    for (const int lag_after : {0, 2}) {
      CAPTURE(c.name, lag_after);
      const Model model = hht_frictional_box(c, OutsidePolicy::remove);
      HistoryTestBox cpu(model, {}, make_cpu), cuda(model, {}, make_cuda);
      for (HistoryTestBox* box : {&cpu, &cuda}) box->start();
      for (int step = 0; step < 60; ++step) {
        for (HistoryTestBox* box : {&cpu, &cuda}) frictional_hht_step(*box, kHhtStep, lag_after);
        check_equal(kFrictionalBoxKinds[0], cpu, cuda);
      }
      CHECK(cuda.backend->reports().ledger(0).rotation.losses.of[kFrictionLoss] > 0);
      HistoryTestBox on_cpu(model, {}, make_cpu), on_cuda(model, {}, make_cuda);
      on_cpu.motion = on_cuda.motion = cpu.motion;
      on_cpu.start(cuda.state()), on_cuda.start(cpu.state());
      for (int step = 0; step < 10; ++step)
        for (HistoryTestBox* box : {&on_cpu, &on_cuda}) frictional_hht_step(*box, kHhtStep, lag_after);
      check_equal(kFrictionalBoxKinds[0], on_cpu, on_cuda);
    }
}

// Contacts with walls alone already exceed the buffer of the records; with many contacts per particle all
// buffers are used in turn. Lists that are built without motion leave the forces unchanged.
TEST_CASE(
    "contacts with walls alone, and very many of each particle, go from list to list on both backends") {
  const BoxCase& c = kFrictionalBoxes[3];
  for (const FrictionalBoxKind& kind : kFrictionalBoxKinds)
    for (const bool crowded : {false, true}) {
      CAPTURE(kind.name, crowded);
      Model model = kind.of(with_friction(crowded ? random_box(c, 2000, 33) : sliding_box(c)));
      model.contact.skin = 0.02;
      HistoryTestBox cpu(model, {}, make_cpu), cuda(model, {}, make_cuda);
      for (HistoryTestBox* box : {&cpu, &cuda}) box->start();
      for (int part = 0; part < 8; ++part) {
        for (HistoryTestBox* box : {&cpu, &cuda})
          box->take_steps(25, crowded ? 5e-5 : kMovingStep), box->backend->list().build(0.02, box->timers);
        check_equal(kind, cpu, cuda);
      }
      const std::size_t contacts = cuda.state().contacts.keys.size();
      CHECK((crowded ? contacts > 3 * model.particles.size() : contacts == model.particles.size()));
    }
}

// Steps so short that rows are pruned several times between two lists.
TEST_CASE("friction of many particles is the same on both backends") {
  const Launches before = launches();
  for (const FrictionalBoxKind& kind : kFrictionalBoxKinds)
    for (const bool several_at_once : {false, true}) {
      const BoxCase& c = kFrictionalBoxes[several_at_once ? 0 : 2];
      CAPTURE(kind.name, c.name, several_at_once);
      launches().several_at_once = several_at_once;
      Model model = kind.of(with_friction(dense_box(c, ParticleIntegrator::velocity_verlet, 20000)));
      model.contact.skin = 0.02;
      HistoryTestBox cpu(model, {}, make_cpu), cuda(model, {}, make_cuda);
      for (HistoryTestBox* box : {&cpu, &cuda}) box->start(), box->take_steps(300, 1e-5);
      CHECK(cuda.backend->list().builds() > 1);
      check_equal(kind, cpu, cuda), check_ledgers(cpu, cuda);
    }
  launches() = before;
}

}  // namespace scree
