// Explicit steps beside walls with prescribed motion and conveyors, taken at once: particles, contact history
// and wrenches have the bits of steps taken one by one. Sums of several steps are added up together.
#include "dem/host/step_loads.hpp"
#include "model/derived/random.hpp"
#include "unit/coupling/driven_box.hpp"

namespace scree {

TEST_CASE("steps beside driven walls at once have the bits of single steps") {
  std::vector<Model> models{escaping_model(1), escaping_model(3), fast_wall_model()};
  for (const DrivenCase& c : kDrivenCases) models.push_back(model_of(c.deck));
  for (const Model& model : models) {
    const DrivenOutcome single = driven_steps(model, make_test_backend, 0);
    CHECK(any_force(single));
    CHECK(single.builds > 2);
    for (const Index at_once : {Index{7}, kSteps}) {
      CAPTURE(at_once);
      check_same(single, driven_steps(model, make_test_backend, at_once));
    }
  }
}

TEST_CASE("a particle that escapes ends the steps beside driven walls with a step of the bodies") {
  for (const int substeps : {1, 3}) {
    const DrivenOutcome out = driven_steps(escaping_model(substeps), make_test_backend, kSteps);
    CHECK(out.closed > 150);
    CHECK(out.closed < 250);
    CHECK(out.closed % substeps == 0);
  }
}

TEST_CASE("sums of the contacts of several steps give the wrenches of each step") {
  const Model model = model_of(kGrains + kPlane + kBelt + kMesh + kShaken);
  const SurfaceSet surfaces(model);
  RandomNumbers random(5);
  constexpr std::int64_t kTaken = 3;
  std::vector<BodyWrench> expected(kTaken * surfaces.parents());
  std::vector<StepLoads> loads;
  for (std::int64_t step = kTaken - 1; step >= 0; --step)
    for (Index s = 0; s < surfaces.placed(); ++s) {
      if (step == 1 && s == 0) continue;  // a surface without contacts is not handed over
      InstantSums whole, parts[2];
      for (int k = 0; k < 10; ++k) {
        SurfaceLoad contact{};
        contact.load.force = {random.normal(), random.normal(), random.normal()};
        contact.arm = {random.normal(), random.normal(), random.normal()};
        contact.belt_power = random.normal();
        whole.add_contact(contact), parts[k % 2].add_contact(contact);
      }
      for (InstantSums& part : parts) part.surface = s, loads.push_back({step, part});
      const auto row = as_size(step) * surfaces.parents();
      expected[row + as_size(surfaces.at(s).parent)] = whole.wrench();
    }
  CHECK(same_bits(wrenches_of_steps(loads, kTaken, surfaces, {}), expected));
}

}  // namespace scree
