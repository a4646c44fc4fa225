// Contact histories against a record kept by brute force, over lists, crossings of periodic sides and
// escaping particles.
#include "random_box.hpp"
#include "support/catch.hpp"
#include "support/contact_record.hpp"
#include "support/history_test_backend.hpp"
#include "support/particle_bits.hpp"

namespace scree {

namespace {

constexpr int kNumbers = 8, kSteps = 300;
constexpr Real kStep = 5e-4, kSkin = 0.03;

Model moving_box(const BoxCase& c, int particles = 150) {
  Model model = random_box(c, particles, 21);
  model.integrator.particles = ParticleIntegrator::velocity_verlet;
  model.contact.skin = kSkin;
  for (NormalLawParameters& law : model.contact.laws) law.exponent = 1;
  if (c.walls && c.periodic_axes > 0) {  // walls along the periodic axis alone do not repeat
    model.walls.resize(1);
    model.walls[0].normal = {0, 1, 0};
  }
  return model;
}

// Moves the bodies with their velocities.
void move_bodies(LoadedBox& box, Real h) {
  for (BodyMotion& body : box.motion) body.position += h * body.velocity;
}

// Removes escaped particles; the list is built anew.
bool leave(LoadedBox& box) {
  const std::vector<EscapedParticle> escaped_particles = box.backend->particles().outside();
  if (escaped_particles.empty()) return false;
  box.backend->particles().remove_escaped(escaped_particles);
  box.backend->list().build(kSkin, box.timers);
  return true;
}

}  // namespace

TEST_CASE("contact histories are those of a record kept by brute force") {
  for (const BoxCase& c : kBoxes)
    for (const OutsidePolicy leaving : {OutsidePolicy::drift, OutsidePolicy::remove}) {
      CAPTURE(c.name, static_cast<int>(leaving));
      Model model = moving_box(c);
      model.space.leaving = leaving;
      LoadedBox box(model, kSkin, make_history_test_backend<kNumbers>);
      ContactRecord<kNumbers> record(box.model);
      RankParticles& particles = box.backend->particles();
      std::string wrong;
      std::size_t contacts = 0;
      for (int step = 0; step < kSteps && wrong.empty(); ++step) {
        verlet_steps(box, kStep, 1);
        record.add_step(particles.records(), box.motion);
        leave(box);
        const std::vector<Particle> records = particles.records();
        const PackedHistory expected = record.contacts(records);
        contacts += expected.keys.size();
        if (const std::string found = difference(particles.contacts(), expected); !found.empty())
          wrong = "step " + std::to_string(step) + ": " + found;
        CHECK(unmirrored<kNumbers>(records, expected) == 0);
        move_bodies(box, kStep);
      }
      CHECK(wrong == "");
      CHECK(contacts > 20 * kSteps);
      CHECK(record.ended() > 50);
      CHECK((record.moved_on() > 0) == (c.periodic_axes > 0));
      CHECK(box.backend->list().builds() > 5);
    }
}

TEST_CASE("reports between steps, and batches of steps, do not change contact histories") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    LoadedBox one(moving_box(c), kSkin, make_history_test_backend<3>),
        queried(moving_box(c), kSkin, make_history_test_backend<3>);
    RankParticles &a = one.backend->particles(), &b = queried.backend->particles();
    for (int part = 0; part < 6; ++part) {
      const Index steps =
          one.motion.empty() ? 15 : 1;  // one batch where no body needs a new pose between steps
      for (Index left = steps; left > 0;)
        left -= verlet_steps(one, kStep, left);  // a batch ends where particles escape
      for (Index k = 0; k < steps; ++k) {
        verlet_steps(queried, kStep, 1);
        queried.backend->reports().ledger(kStep);
        queried.backend->reports().parent_contacts();
        queried.backend->list().build(0.01 * (k % 5 + 1), queried.timers);
      }
      CHECK(differing_fields(a.records(), b.records()) == "");
      CHECK(difference(a.contacts(), b.contacts()) == "");
      CHECK(a.contacts().content == HistoryContent::of_law(3));
    }
    // Back into a backend without history.
    LoadedBox onward(moving_box(c), kSkin, make_history_test_backend<3>);
    onward.motion = one.motion;
    onward.backend->particles().load(a.records(), {});
    onward.backend->particles().load_contacts(a.contacts());
    CHECK(difference(onward.backend->particles().contacts(), a.contacts()) == "");
    onward.backend->list().set_body_motion(onward.motion);
    onward.backend->list().build(kSkin, onward.timers);
    CHECK(difference(onward.backend->particles().contacts(), a.contacts()) == "");
    for (LoadedBox* box : {&one, &onward}) verlet_steps(*box, kStep, 10);
    CHECK(differing_fields(a.records(), onward.backend->particles().records()) == "");
    CHECK(difference(a.contacts(), onward.backend->particles().contacts()) == "");
  }
}

TEST_CASE("a law without history stores none") {
  LoadedBox box(moving_box(kBoxes[4]), kSkin);
  box.backend->particles().load_contacts(no_contacts(HistoryContent::of_law(3), 150));
  verlet_steps(box, kStep, 3);
  const PackedHistory contacts = box.backend->particles().contacts();
  CHECK(!contacts.content.exists());
  CHECK(contacts.particles() == 0);
}

}  // namespace scree
