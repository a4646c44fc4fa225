// Contact histories on the GPU against the CPU: bit for bit, with and without pruned rows and with either
// form of the step's kernel, and from one backend to the other.
#include "dem/backend/device.hpp"
#include "launches.hpp"
#include "support/catch.hpp"
#include "support/contact_record.hpp"
#include "support/history_test_box.hpp"
#include "support/particle_bits.hpp"

namespace scree {
namespace {

void check_equal(const HistoryTestBox& cpu, const HistoryTestBox& cuda) {
  const State a = cpu.state(), b = cuda.state();
  CHECK(differing_fields(a.particles, b.particles) == "");
  CHECK(difference(a.contacts, b.contacts) == "");
  CHECK(a.contacts.keys.size() > 5);
  CHECK(unmirrored<kHistoryNumbers>(b.particles, b.contacts) == 0);
}

}  // namespace

TEST_CASE("contact histories are the same on both backends") {
  for (const BoxCase& c : kBoxes)
    for (const OutsidePolicy leaving : {OutsidePolicy::drift, OutsidePolicy::remove}) {
      CAPTURE(c.name, static_cast<int>(leaving));
      const Model model = moving_box(c, leaving);
      HistoryTestBox cpu(model, {}, make_history_test_cpu_backend<kHistoryNumbers>),
          cuda(model, {}, make_history_test_cuda_backend<kHistoryNumbers>);
      for (HistoryTestBox* box : {&cpu, &cuda}) box->start();
      for (int part = 0; part < 20; ++part) {
        for (HistoryTestBox* box : {&cpu, &cuda}) box->take_steps(1 + 2 * part);
        check_equal(cpu, cuda);
      }
      // Each backend continues from the other's state.
      HistoryTestBox on_cpu(model, {}, make_history_test_cpu_backend<kHistoryNumbers>),
          on_cuda(model, {}, make_history_test_cuda_backend<kHistoryNumbers>);
      on_cpu.motion = on_cuda.motion = cpu.motion;
      on_cpu.start(cuda.state()), on_cuda.start(cpu.state());
      check_equal(on_cpu, on_cuda);
      for (HistoryTestBox* box : {&on_cpu, &on_cuda}) box->take_steps(50);
      check_equal(on_cpu, on_cuda);
    }
}

// Steps so short that rows are pruned several times between two lists.
TEST_CASE("contact histories of many particles are the same on both backends") {
  const Launches before = launches();
  for (const BoxCase& c : {kBoxes[1], kBoxes[5]})
    for (const bool several_at_once : {false, true}) {
      CAPTURE(c.name, several_at_once);
      launches().several_at_once = several_at_once;
      Model model = dense_box(c, ParticleIntegrator::velocity_verlet, 20000);
      model.contact.skin = 0.02;
      HistoryTestBox cpu(model, {}, make_history_test_cpu_backend<kHistoryNumbers>),
          cuda(model, {}, make_history_test_cuda_backend<kHistoryNumbers>);
      for (HistoryTestBox* box : {&cpu, &cuda}) box->start(), box->take_steps(300, 1e-5);
      CHECK(cuda.backend->list().builds() > 1);
      check_equal(cpu, cuda);
    }
  launches() = before;
}

TEST_CASE("contacts of more particles than are transferred at a time are the same on both backends") {
  Model model = dense_box(kBoxes[6], ParticleIntegrator::velocity_verlet, kRowsAtOnce + 20000);
  model.contact.skin = 0.02;
  HistoryTestBox cpu(model, {}, make_history_test_cpu_backend<kHistoryNumbers>),
      cuda(model, {}, make_history_test_cuda_backend<kHistoryNumbers>);
  for (HistoryTestBox* box : {&cpu, &cuda}) box->start(), box->take_steps(3, 1e-5);
  check_equal(cpu, cuda);
}

TEST_CASE("contact histories in mixed precision") {
  Model model = dense_box(kBoxes[4], ParticleIntegrator::velocity_verlet, 20000);
  for (NormalLawParameters& law : model.contact.laws) law.exponent = 1;
  model.contact.skin = 0.02, model.integrator.precision = Precision::mixed;
  HistoryTestBox mixed(model, {}, make_history_test_cuda_backend<3>);
  model.integrator.precision = Precision::full;
  HistoryTestBox exact(model, {}, make_history_test_cuda_backend<3>);
  for (HistoryTestBox* box : {&mixed, &exact}) box->start(), box->take_steps(60, 1e-5);
  const State a = mixed.state(), b = exact.state();
  CHECK(unmirrored<3>(a.particles, a.contacts) == 0);
  CHECK(a.contacts.offsets == b.contacts.offsets);
  REQUIRE(a.contacts.keys == b.contacts.keys);
  CHECK(a.contacts.keys.size() > 20000);
  Real largest = 0, scale = 0;
  for (std::size_t k = 0; k < a.contacts.values.size(); ++k) {
    largest = std::max(largest, std::abs(a.contacts.values[k] - b.contacts.values[k]));
    scale = std::max(scale, std::abs(b.contacts.values[k]));
  }
  CHECK(largest < 1e-4 * scale);
}

}  // namespace scree
