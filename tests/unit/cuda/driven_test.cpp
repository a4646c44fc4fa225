// Beside walls with prescribed motion and conveyors the GPU takes many explicit steps at once: their poses
// are in a table, and the sums of their contacts in a ring. Particles, contact history and wrenches have the
// bits of steps taken one by one, and of the CPU's.
#include "dem/backend/device.hpp"
#include "launches.hpp"
#include "unit/coupling/driven_box.hpp"

namespace scree {

TEST_CASE("steps beside driven walls at once have the bits of single steps and of the CPU's") {
  for (const DrivenCase& c : kDrivenCases) {
    CAPTURE(c.name);
    const Model model = model_of(c.deck);
    const DrivenOutcome cpu = driven_steps(model, make_cpu_backend, 0),
                        single = driven_steps(model, make_cuda_backend, 0);
    CHECK(cpu.closed == kSteps);
    CHECK(any_force(cpu));
    check_same(cpu, single);
    check_same(cpu, driven_steps(model, make_cpu_backend, kSteps));
    for (const Index at_once : kAtOnce) {
      CAPTURE(at_once);
      const DrivenOutcome batch = driven_steps(model, make_cuda_backend, at_once);
      check_same(cpu, batch);
      CHECK(batch.builds > 2);  // batches end where the list expires
    }
  }
}

TEST_CASE("steps beside driven walls end after the step of the bodies in which a particle escapes") {
  for (const int substeps : {1, 3}) {
    const Model model = escaping_model(substeps);
    const DrivenOutcome cpu = driven_steps(model, make_cpu_backend, 0);
    CHECK(cpu.closed > 150);
    CHECK(cpu.closed < 300);
    CHECK(cpu.closed % substeps == 0);
    for (const Index at_once : kAtOnce) {
      CAPTURE(substeps, at_once);
      check_same(cpu, driven_steps(model, make_cuda_backend, at_once));
    }
  }
}

// The wall moves so far that the list expires by its motion, between the expiries by that of particles.
TEST_CASE("steps beside driven walls end where the list no longer covers the walls") {
  const Model model = fast_wall_model();
  const DrivenOutcome cpu = driven_steps(model, make_cpu_backend, 0);
  CHECK(any_force(cpu));
  for (const Index at_once : kAtOnce) {
    CAPTURE(at_once);
    const DrivenOutcome batch = driven_steps(model, make_cuda_backend, at_once);
    check_same(cpu, batch);
    CHECK(batch.builds > 20);  // the mesh may move by 3 mm, which takes 15 steps
  }
}

// Many entries, so that a surface has more than one chunk and its particles are launched separately.
TEST_CASE("steps beside driven walls do not depend on the form of the launches") {
  const Model model = model_of(kGrains + kMesh + kShaken + kPlane + kBelt);
  const DrivenOutcome expected = driven_steps(model, make_cuda_backend, 0);
  for (const bool in_parts : {false, true}) {
    const Launches before = launches();
    launches().in_parts = in_parts;
    check_same(expected, driven_steps(model, make_cuda_backend, kSteps));
    launches() = before;
  }
}

}  // namespace scree
