// Histories of frictional contacts with bodies after a step are those of the bodies' last pose, however
// often it is queried.
#include "support/backends.hpp"
#include "support/catch.hpp"
#include "support/contact_record.hpp"
#include "support/frictional_box.hpp"
#include "support/particle_bits.hpp"

namespace scree {

namespace {

void shift_bodies(HistoryTestBox& box, Real shift, Real turn) {
  for (BodyMotion& body : box.motion) body.position += Vec3{shift, -shift, 0}, body.angle += turn;
  box.backend->list().set_body_motion(box.motion);
}

// Contacts with bodies alone.
PackedHistory with_bodies(const HistoryTestBox& box) {
  const PackedHistory all = box.state().contacts;
  PackedHistory out;
  out.content = all.content;
  const GlobalId first = surface_id(static_cast<Index>(box.model.walls.size()));
  for (std::int64_t i = 0; i < all.particles(); ++i) {
    for (std::int64_t k = all.offsets[static_cast<std::size_t>(i)];
         k < all.offsets[static_cast<std::size_t>(i) + 1]; ++k)
      if (id_of(all.keys[static_cast<std::size_t>(k)]) >= first)
        out.add(all.keys[static_cast<std::size_t>(k)], all.values_of(k));
    out.end_row();
  }
  return out;
}

// The boxes with bodies and friction.
template <class Check>
void for_each_box(const Check& check) {
  for (const BoxCase& c : kFrictionalBoxes) {
    if (!c.bodies) continue;
    CAPTURE(c.name);
    check(moving_frictional_box(c, OutsidePolicy::drift));
  }
}

}  // namespace

TEST_CASE("queries of the bodies after a step and in reports do not change contact histories") {
  for_each_box([](const Model& model) {
    HistoryTestBox one(model, {}, make_test_backend), queried(model, {}, make_test_backend);
    for (HistoryTestBox* box : {&one, &queried}) box->start(), box->take_steps(60);
    one.take_steps(40), queried.take_steps(40, kMovingStep, 3);
    queried.backend->reports().ledger(kMovingStep), queried.backend->reports().parent_contacts();
    CHECK(difference(one.state().contacts, queried.state().contacts) == "");
    CHECK(differing_fields(one.state().particles, queried.state().particles) == "");
    CHECK(!with_bodies(one).keys.empty());
  });
}

TEST_CASE("contact histories of a step to the bodies' corrected pose are those of a direct step") {
  for_each_box([](const Model& model) {
    HistoryTestBox at_once(model, {}, make_test_backend), corrected(model, {}, make_test_backend);
    for (HistoryTestBox* box : {&at_once, &corrected}) box->start(), box->take_steps(60);
    REQUIRE(!with_bodies(at_once).keys.empty());
    constexpr Real kShift = 2e-5, kTurn = 3e-4;
    for (HistoryTestBox* box : {&at_once, &corrected}) {
      const std::unique_ptr<ExplicitRun> run = box->backend->start_run(kMovingStep);
      shift_bodies(*box, kShift, kTurn);
      if (box == &corrected) shift_bodies(*box, -3 * kShift, kTurn);
      run->take_steps(1, false, box->timers);
      if (box == &corrected) shift_bodies(*box, 3 * kShift, -kTurn), run->shape_contacts();
    }
    at_once.motion = corrected.motion;
    const PackedHistory a = with_bodies(at_once), b = with_bodies(corrected);
    CHECK(a.offsets == b.offsets);
    CHECK(a.keys == b.keys);
    Real largest = 0, scale = 0;
    for (std::size_t k = 0; k < a.values.size() && k < b.values.size(); ++k)
      largest = std::max(largest, std::abs(a.values[k] - b.values[k])),
      scale = std::max(scale, std::abs(a.values[k]));
    CHECK(largest < 1e-9 * scale);  // of the bodies' positions; corrections leave round-off
  });
}

}  // namespace scree
