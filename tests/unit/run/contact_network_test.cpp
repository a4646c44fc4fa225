// The contacts in snapshots agree with other outputs for each particle, and leave no trace.
#include "run/record/contact_network.hpp"

#include <algorithm>

#include "dem/history/contact_key.hpp"
#include "support/catch.hpp"
#include "support/frictional_box.hpp"
#include "support/near.hpp"

namespace scree {
namespace {

constexpr Real kRoundOff = 1e-11;  // of forces of up to some 100 N, and of lengths

bool with_surface(const ContactLine& line) { return surface_with_id(line.second) >= 0; }

// Sums per particle.
struct Sums {
  Sums(const ContactLines& of, std::size_t particles) : force(particles), contacts(particles) {
    for (const ContactLine& line : of.lines) {
      add(line.first, line.contact.force);
      if (!with_surface(line)) add(line.second, -line.contact.force);
    }
  }
  void add(GlobalId id, Vec3 part) {
    force[static_cast<std::size_t>(id)] += part;
    ++contacts[static_cast<std::size_t>(id)];
  }

  std::vector<Vec3> force;
  std::vector<int> contacts;
};

// Whether a and b are a whole number of periods apart.
bool same_position(Vec3 a, Vec3 b, Vec3 period) {
  const auto apart = [](Real x, Real length) {
    return length > 0 ? std::abs(x - length * std::round(x / length)) : std::abs(x);
  };
  const Vec3 d = a - b;
  return std::max({apart(d.x, period.x), apart(d.y, period.y), apart(d.z, period.z)}) < kRoundOff;
}

void check_line(const ContactLine& line, const Model& model, const std::vector<Vec3>& position) {
  const ShownContact& c = line.contact;
  const auto i = static_cast<std::size_t>(line.first);
  REQUIRE(line.start == position[i]);
  REQUIRE(near(std::hypot(c.normal_force, c.tangential_force), norm(c.force), {kRoundOff, kRoundOff}));
  const Index surface = surface_with_id(line.second);
  if (surface >= std::ssize(model.walls)) return;
  Real reach = model.particles.radius[i];
  if (!with_surface(line)) {
    REQUIRE(line.first <= line.second);
    const auto j = static_cast<std::size_t>(line.second);
    reach += model.particles.radius[j];
    REQUIRE(same_position(line.start + c.branch, position[j], Subdomain(model.space).period()));
  }
  // The centre may be behind a wall.
  REQUIRE(near(norm(c.branch), std::abs(reach - c.overlap), {.absolute = kRoundOff}));
}

// Forces of the state on the backend are those at its instant.
ContactLines check_lines(const Model& model, Backend& backend) {
  ContactLines lines = backend.reports().contact_lines();
  const BoxOutput output(backend);
  const std::size_t particles = model.particles.size();
  const Sums sums(lines, particles);
  std::vector<Vec3> position(particles);
  for (std::size_t k = 0; k < output.all.global_id.size(); ++k) {
    const auto id = static_cast<std::size_t>(output.all.global_id[k]);
    position[id] = output.all.position[k];
    REQUIRE(sums.contacts[id] == output.of<int>("contacts")[k]);
    REQUIRE(near(sums.force[id], output.of<Vec3>("force")[k], {kRoundOff, kRoundOff}));
  }
  std::size_t line = 0;
  for (std::size_t k = 0; k < lines.global_id.size(); ++k)
    for (std::int64_t left = lines.counts[k]; left > 0; --left, ++line) {
      REQUIRE(lines.lines.at(line).first == lines.global_id[k]);
      check_line(lines.lines[line], model, position);
    }
  CHECK(line == lines.lines.size());
  CHECK(line > 5);
  return lines;
}

}  // namespace

TEST_CASE("lines of contacts add up to forces on particles and walls, and each contact has one") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    LoadedBox box(random_box(c, 120, 17), 0.2);
    const ContactLines lines = check_lines(box.model, *box.backend);
    if (!c.walls || c.bodies) continue;
    for (int w = 0; w < static_cast<int>(box.model.walls.size()); ++w) {
      const ContactSum wall = box.backend->reports().wall_contacts(std::vector{w}).front();
      Vec3 force{};
      std::int64_t contacts = 0;
      for (const ContactLine& line : lines.lines)
        if (line.second == surface_id(w)) force += -line.contact.force, ++contacts;
      CHECK((contacts == wall.contacts && contacts > 0));
      CHECK(near(force, wall.force, {kRoundOff, kRoundOff}));
    }
  }
}

TEST_CASE("lines of frictional, rolling and adhesive contacts have their springs, and move nothing") {
  for (const FrictionalBoxKind& kind : kFrictionalBoxKinds)
    for (const BoxCase& c : kFrictionalBoxes) {
      CAPTURE(kind.name, c.name);
      const Model model = kind.of(moving_frictional_box(c, OutsidePolicy::drift));
      HistoryTestBox run(model, {}, make_test_backend), box(model, {}, make_test_backend);
      run.start(), run.take_steps(60);
      box.motion = run.motion, box.start(run.state());
      box.backend->particles().initial_forces();
      const std::string before = box.hash();
      const ContactLines lines = check_lines(model, *box.backend);
      CHECK(lines.of_bodies.empty() == !c.bodies);
      Real energy = 0;
      for (const std::vector<ContactLine>* some : {&lines.lines, &lines.of_bodies})
        for (const ContactLine& line : *some) energy += 800.0 / 2 * line.contact.slip * line.contact.slip;
      const Real springs = box.backend->reports().ledger(0).rotation.friction_springs;
      CHECK(springs > 0);
      if (c.modulus == 0) CHECK(near(energy, springs, {.relative = 1e-12}));
      CHECK(box.hash() == before);
    }
}

TEST_CASE("columns of contacts identify the end of each line") {
  LoadedBox box(with_friction(random_box(kFrictionalBoxes[5], 150, 17)), 0.2);
  Model& model = box.model;
  model.walls.push_back({"side", {0.85, 0, 0}, {-1, 0, 0}, 0});
  const SurfaceSet surfaces(model);
  ContactLines lines{{7, 3}, {1, 3}, {}, {}};
  const GlobalId body = surface_id(surfaces.ground() + surfaces.placed() - 1);
  for (const auto& [first, second] :
       {std::pair<GlobalId, GlobalId>{7, surface_id(0)}, {3, 5}, {3, 9}, {3, body}})
    lines.lines.push_back({first, second, {1, 2, 3}, {{0, 1, 0}, {}, 0, 0, 0, 0.5}});
  for (const GlobalId second : {body, surface_id(0)})
    lines.of_bodies.push_back({surface_id(surfaces.ground()), second, {}, {{0, 1, 0}, {}, 0, 0, 0, 0}});
  const ContactNetwork network(model, {}, 10, lines);
  const LineSnapshot shown = network.snapshot();
  CHECK(shown.ends[5] == Vec3{1, 3, 3});
  std::vector<std::string> names;
  for (const PointField& field : shown.fields) {
    names.push_back(field.name);
    const auto integers = [&]<class T>(const T* values) { return std::vector<int>(values, values + 6); };
    const std::vector<int> values = std::visit(integers, field.values);
    if (field.name == "first") CHECK(values == std::vector{-1, -1, 3, 3, 3, 7});
    if (field.name == "second") CHECK(values == std::vector{-1, -1, 5, 9, -1, -1});
    if (field.name == "kind") CHECK(values == std::vector{2, 1, 0, 0, 2, 1});
    if (field.name == "wall") CHECK(values == std::vector{-1, 0, -1, -1, -1, 0});
    if (field.name == "body") CHECK(values == std::vector{4, -1, -1, -1, 4, -1});
    if (field.name == "first_body") CHECK(values == std::vector{0, 0, -1, -1, -1, -1});
  }
  CHECK(names == ContactNetwork::field_names(model));
  CHECK(std::ranges::count(names, "slip") == 1);
  CHECK(std::ranges::count(ContactNetwork::field_names(random_box(kBoxes[0], 10, 1)), "slip") == 0);
}

}  // namespace scree
