// Contact histories return from a checkpoint bit for bit, enter the hash, and are refused where they are
// inconsistent; without histories a checkpoint has none.
#include "run/state/contact_rows.hpp"

#include "base/error.hpp"
#include "dem/history/contact_key.hpp"
#include "output/hdf5_file.hpp"
#include "run/restart/checkpoint_datasets.hpp"
#include "run/state/state.hpp"
#include "support/catch.hpp"
#include "support/decks.hpp"
#include "support/state_bits.hpp"
#include "unit/output/scratch.hpp"

namespace scree {

namespace {

constexpr std::int64_t kParticles = 4;

// Four particles with 2, 0, 3 and 1 contacts.
State state_with_history(int numbers) {
  State state;
  for (GlobalId id = 0; id < kParticles; ++id) {
    fill_fields(state.particles.emplace_back(), id);
    state.particles.back().global_id = id;
  }
  PackedHistory& contacts = state.contacts;
  contacts.content = HistoryContent::of_law(numbers);
  Real next = 0.1;
  const auto add = [&](const ContactKey& key) {
    std::vector<Real> values;
    for (int k = 0; k < numbers; ++k) values.push_back(k == 1 ? -0.0 : next /= 3);
    contacts.add(key.pack(), values);
  };
  add(ContactKey::particle(2)), add(ContactKey::surface(5, 12)), contacts.end_row();
  contacts.end_row();
  add(ContactKey::particle(0)), add(ContactKey::particle(3, 0)), add(ContactKey::particle(3, 26));
  contacts.end_row();
  add(ContactKey::particle(2, 26)), contacts.end_row();
  return state;
}

std::string difference(const PackedHistory& a, const PackedHistory& b) {
  if (a.content != b.content) return "content";
  if (a.offsets != b.offsets || a.keys != b.keys) return "contacts";
  return same_bits(a.values, b.values) ? "" : "values";
}

std::string refusal(const State& state) {
  try {
    ParticleSet deck;
    deck.totals.at_start = kParticles;
    check_state(state, "some.h5", deck, {});
  } catch (const IoError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("contact histories pass through a file bit for bit") {
  for (const int numbers : {1, 3, 4, 7}) {
    CAPTURE(numbers);
    const State state = state_with_history(numbers);
    CHECK(difference(unpack(pack(state)).contacts, state.contacts) == "");
    const ScratchDirectory folder;
    write_checkpoint(folder / "c.h5", pack(state));
    CHECK(difference(unpack(read_checkpoint(folder / "c.h5")).contacts, state.contacts) == "");
    const Hdf5File file(folder / "c.h5", Hdf5Access::read);
    for (const auto& [name, rows, width] : {std::tuple("/integer_rows/contacts/count", 4, 1),
                                            {"/integer_rows/contacts/partner", 6, 1},
                                            {"/integer_rows/contacts/image", 6, 1},
                                            {"/real_rows/contacts/history", 6, numbers}}) {
      CAPTURE(name);
      CHECK(file.rows(name) == rows);
      CHECK(file.width(name) == width);
      CHECK(file.read_text_attribute(name, "unit") != "");
      CHECK(file.read_text_attribute(name, "description") != "");
    }
  }
}

TEST_CASE("a checkpoint has rows of contacts only with a law with history") {
  const State state = state_with_history(0);
  for (const auto& [name, rows] : pack(state).real_rows) CHECK_FALSE(contains(name, "contacts"));
  for (const auto& [name, rows] : pack(state).integer_rows) CHECK_FALSE(contains(name, "contacts"));
  CHECK(!unpack(pack(state)).contacts.content.exists());
  // Both are checkpoints of the same model; one with a part of the rows is not.
  const Model model;
  const auto trouble = [&](const Checkpoint& checkpoint) -> std::string {
    try {
      check_datasets(checkpoint, model, {});
    } catch (const IoError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(trouble(pack(state)) == "");
  const State with_history = state_with_history(3);
  CHECK(trouble(pack(with_history)) == "");
  for (const char* name : {"contacts/count", "contacts/partner", "contacts/image"}) {
    Checkpoint partial = pack(with_history);
    partial.integer_rows.erase(name);
    CHECK(contains(trouble(partial), std::string(name) + " is missing"));
  }
  Checkpoint partial = pack(with_history);
  partial.real_rows.erase("contacts/history");
  CHECK(contains(trouble(partial), "is not known"));
}

TEST_CASE("the hash covers contact histories, and nothing else where there are none") {
  const State state = state_with_history(7);
  const std::uint64_t hash = state_hash(state, true);
  for (std::size_t k = 0; k < state.contacts.keys.size(); ++k) {
    State other = state;
    ++other.contacts.keys[k];
    CHECK(state_hash(other, true) != hash);
  }
  for (std::size_t k = 0; k < state.contacts.values.size(); ++k) {
    State other = state;
    other.contacts.values[k] = -other.contacts.values[k];
    CHECK(state_hash(other, true) != hash);
  }
  State moved = state;  // a contact is assigned to the next particle
  ++moved.contacts.offsets[1];
  CHECK(state_hash(moved, true) != hash);
  State none = state;
  none.contacts = no_contacts(HistoryContent::of_law(7), kParticles);
  CHECK(state_hash(none, true) != hash);
  CHECK(state_hash(none, true) == state_hash(state_with_history(0), true));
}

TEST_CASE("contacts that no state of the deck can have are refused") {
  const State state = state_with_history(3);
  CHECK(refusal(state) == "");
  const auto with = [&](const auto& change) {
    State other = state;
    change(other.contacts);
    return refusal(other);
  };
  CHECK(contains(with([](PackedHistory& c) { c.values[4] = std::nan(""); }), "is not finite"));
  CHECK(contains(with([](PackedHistory& c) { std::swap(c.keys[2], c.keys[3]); }),
                 "particle 2 are out of order"));
  CHECK(contains(with([](PackedHistory& c) { c.keys[5] = ContactKey::particle(kParticles).pack(); }),
                 "with particle 4"));
  CHECK(contains(with([](PackedHistory& c) { c.offsets.pop_back(); }), "another number of particles"));
  const auto unpacked = [&](const char* name, std::int64_t value) -> std::string {
    Checkpoint changed = pack(state);
    auto& rows = changed.integer_rows.at(name);
    rows.copy = [copy = rows.copy, value](std::int64_t first, std::int64_t count, std::int64_t* to) {
      copy(first, count, to);
      to[2] = value;
    };
    try {
      unpack(changed);
    } catch (const IoError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(contains(unpacked("contacts/count", -1), "number of contacts of a particle is not valid"));
  CHECK(contains(unpacked("contacts/count", 1000), "number of contacts of a particle is not valid"));
  CHECK(contains(unpacked("contacts/count", 2), "do not fit together"));
  CHECK(contains(unpacked("contacts/image", 27), "image of a contact is not valid"));
  CHECK(contains(unpacked("contacts/partner", -1), "image of a contact is not valid"));
}

TEST_CASE("the histories of contacts with walls can be left out") {
  PackedHistory all;
  all.content = HistoryContent::of_law(1);
  const Real values[] = {1, 2, 3};
  const std::int64_t of_particle = ContactKey::particle(5).pack();
  all.add(of_particle, {values, 1}), all.add(ContactKey::surface(0).pack(), {values + 1, 1}), all.end_row();
  all.add(ContactKey::surface(3).pack(), {values + 2, 1}), all.end_row();
  const PackedHistory left = all.without_surfaces();
  CHECK(left.content == all.content);
  CHECK(left.offsets == std::vector<std::int64_t>{0, 1, 1});
  CHECK(left.keys == std::vector<std::int64_t>{of_particle});
  CHECK(left.values == std::vector<Real>{1});
}

}  // namespace scree
