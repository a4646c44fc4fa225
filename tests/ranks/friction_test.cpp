// Particles with friction on all ranks against one rank: state and contact histories, bit for bit, over
// lists, migration and changes of the boxes.
#include "support/catch.hpp"
#include "support/contact_record.hpp"
#include "support/frictional_box.hpp"
#include "support/particle_bits.hpp"
#include "support/petsc_run.hpp"

namespace scree {

namespace {

constexpr Index kParts = 20, kStepsOfPart = 50;

void check_equal(const FrictionalBoxKind& kind, const HistoryTestBox& one, const HistoryTestBox& many) {
  const State a = one.in_id_order(), own = many.in_id_order();
  CHECK(kind.unmirrored(a.particles, a.contacts) == 0);
  CHECK(differing_fields(a.particles, many.ranks.all_gather(own.particles)) == "");
  CHECK(one.hash() == many.hash());
  CHECK(!a.contacts.keys.empty());
  const ParticleLedger p = one.backend->reports().ledger(kMovingStep),
                       q = many.backend->reports().ledger(kMovingStep);
  if (many.ranks.is_root()) CHECK(p.rotation == q.rotation);  // the other ranks lack the data of bodies
}

}  // namespace

TEST_CASE("particles with friction move on any number of ranks as on one") {
  petsc();
  for (const FrictionalBoxKind& kind : kFrictionalBoxKinds)
    for (const auto& [c, leaving] : moving_cases()) {
      CAPTURE(kind.name, c.name, static_cast<int>(leaving));
      const Model model = kind.of(moving_frictional_box(c, leaving));
      HistoryTestBox many(model, Ranks::world(), make_test_backend), one(model, Ranks(), make_test_backend);
      for (HistoryTestBox* box : {&many, &one}) box->start();
      for (Index part = 0; part < kParts; ++part) {
        for (HistoryTestBox* box : {&many, &one}) box->take_steps(kStepsOfPart);
        check_equal(kind, one, many);
      }
      CHECK(many.backend->list().builds() > 5);
    }
}

TEST_CASE("particles with friction move in implicit steps on any number of ranks as on one") {
  petsc();
  for (const BoxCase& c : kFrictionalBoxes)
    for (const int lag_after : {0, 2}) {
      CAPTURE(c.name, lag_after);
      const Model model = hht_frictional_box(c, OutsidePolicy::remove);
      HistoryTestBox many(model, Ranks::world(), make_test_backend), one(model, Ranks(), make_test_backend);
      for (HistoryTestBox* box : {&many, &one}) box->start();
      for (int step = 0; step < 60; ++step) {
        for (HistoryTestBox* box : {&many, &one}) frictional_hht_step(*box, kHhtStep, lag_after);
        check_equal(kFrictionalBoxKinds[0], one, many);
      }
    }
}

TEST_CASE("particles with friction continue from any number of ranks on any other") {
  petsc();
  for (const FrictionalBoxKind& kind : kFrictionalBoxKinds) {
    const BoxCase& c = kFrictionalBoxes[7];
    CAPTURE(kind.name, c.name);
    const Model model = kind.of(moving_frictional_box(c, OutsidePolicy::remove));
    const Ranks world = Ranks::world();
    HistoryTestBox many(model, world, make_test_backend), one(model, Ranks(), make_test_backend);
    for (HistoryTestBox* box : {&many, &one}) box->start(), box->take_steps(200);
    HistoryTestBox again(model, world, make_test_backend), alone(model, Ranks(), make_test_backend);
    again.motion = alone.motion = one.motion;
    again.start(many.in_id_order()), alone.start(one.in_id_order());
    for (HistoryTestBox* box : {&many, &one, &again, &alone}) box->take_steps(200);
    check_equal(kind, one, many), check_equal(kind, one, again), check_equal(kind, one, alone);
  }
}

}  // namespace scree
