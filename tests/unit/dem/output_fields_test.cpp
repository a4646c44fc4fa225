// The fields of snapshots.
#include "dem/reports/output_fields.hpp"

#include <set>

#include "random_box.hpp"
#include "support/catch.hpp"
#include "support/decks.hpp"
#include "support/particle_bits.hpp"

namespace scree {

TEST_CASE("output fields of the table are what the particles have") {
  for (const BoxCase& c : {kBoxes[1], kBoxes[5]}) {
    CAPTURE(c.name);
    LoadedBox box(random_box(c, 200, 21));
    for (Particle& record : box.records) {
      record.position.x += 0.7;  // some move out of the periodic box
      record.image = {3, -1, 2}, record.contact_loss = 0.1 * static_cast<Real>(record.global_id);
    }
    box.backend->particles().load(box.records, {});
    box.backend->list().build(0.02, box.timers);
    box.backend->particles().initial_forces();
    const BoxOutput output(*box.backend);
    const std::vector<Particle> particles = box.backend->particles().records();
    REQUIRE(output.all.global_id.size() == particles.size());
    std::size_t of_table = 0;
    for_each_field([&](const ParticleField& field, auto member) {
      if ((field.parts & kOutput) == 0) return;
      CAPTURE(field.name);
      ++of_table;
      using Value = std::remove_cvref_t<decltype(std::declval<Particle>().*member)>;
      if constexpr (std::is_constructible_v<OutputValues, std::vector<Value>>) {
        const std::vector<Value>& values = output.of<Value>(field.name);
        for (std::size_t k = 0; k < values.size(); ++k) {
          const auto& particle = particles[static_cast<std::size_t>(output.all.global_id[k])];
          REQUIRE(numbers_of(values[k]) == numbers_of(particle.*member));
        }
      } else {
        FAIL("a type that no column has");
      }
    });
    CHECK(of_table + std::tuple_size_v<DerivedOutputs> + 1 == output_fields().size());  // kGroupOutput
    for (std::size_t k = 0; k < particles.size(); ++k) {
      const auto& particle = particles[static_cast<std::size_t>(output.all.global_id[k])];
      REQUIRE(output.all.position[k] == particle.position);
    }
  }
}

TEST_CASE("each output field has a name of its own, a unit and a sentence") {
  std::set<std::string> names;
  for (const OutputField& field : output_fields()) {
    CHECK(names.insert(field.head.name).second);
    CHECK(std::string(field.head.unit) != "");
    CHECK(std::string(field.head.description) != "");
    CHECK(output_fields_text().find(std::string("  ") + field.head.name + " ") != std::string::npos);
  }
  CHECK(!names.contains("position"));  // present in every snapshot
  CHECK(!names.contains("global_id"));
}

TEST_CASE("a deck with an unknown or repeated output field is refused") {
  const auto error = [](const std::string& fields) {
    return input_error(
        [&] { check_output_fields(parse_deck(kSmallDeck, "deck.toml", {"output.fields=" + fields})); });
  };
  CHECK(error(R"(["mass", "contact_loss"])").empty());
  CHECK(error("[]").empty());
  CHECK(error(R"(["velocty"])").find("there is no output field \"velocty\"") != std::string::npos);
  CHECK(error(R"(["velocty"])").find("\"velocity\"") != std::string::npos);
  CHECK(error(R"(["mass", "mass"])").find("\"mass\" is repeated") != std::string::npos);
}

}  // namespace scree
