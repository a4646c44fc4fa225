// Contact forces, wrenches and sums of the CPU backend against a sum over all pairs.
#include <cmath>
#include <numbers>

#include "physics/normal_laws.hpp"
#include "random_box.hpp"
#include "support/catch.hpp"
#include "support/near.hpp"

namespace scree {

namespace {

constexpr Real kRoundOff = 1e-12;  // relative to the sum of magnitudes
constexpr Real kSum = 32 * kUlp;   // of sums with the particles in another order, relative
constexpr int kParticles = 120;

struct BruteContacts {
  std::vector<Vec3> force;     // per item [N]
  std::vector<int> contacts;   // per item
  std::vector<Tensor> virial;  // per item: stress times volume [J]
  Real elastic = 0;            // of all contacts [J]
  Real magnitude = 0;          // sum of |force| over all contacts [N]
  int count = 0;
};

// One contact of item i: its force, and the fraction `share` of its energy and number.
struct BruteContact {
  Real overlap, rate;
  Vec3 normal;
  Real arm;  // of the force, from the centre of item i against the normal [m]
  PairSize size;
  Real share;
};

template <class NormalLaw>
void add_contact(BruteContacts& sum, const NormalLaw& law, const BruteContact& contact, std::size_t i) {
  const ContactForce c = contact_force(law, contact.overlap, contact.rate);
  const Vec3 f = c.force * contact.normal, x = -contact.arm * contact.normal;
  sum.force[i] += f;
  Tensor& virial = sum.virial[i];
  virial.x += f.x * x, virial.y += f.y * x, virial.z += f.z * x;
  sum.magnitude += std::abs(c.force);
  sum.elastic += contact.share * law.energy(contact.overlap);
  ++sum.contacts[i];
}

void add_contact(BruteContacts& sum, const NormalLawParameters& law, const BruteContact& c, std::size_t i) {
  if (law.effective_modulus > 0) return add_contact(sum, HertzLaw(law).of_pair(c.size), c, i);
  add_contact(sum, PowerLaw(law), c, i);
}

// A body counts as fixed for a particle, and has its mass among bodies, where a law reads masses alone; the
// effective mass is always that of the free body.
PairSize size_of(const BruteItem& a, const BruteItem& b, Vec3 normal) {
  PairSize out{a.radius, b.radius, a.body >= 0 && b.body < 0 ? kInfinity : a.mass,
               b.body >= 0 && a.body < 0 ? kInfinity : b.mass};
  const auto free = [&](const BruteItem& item, const BruteItem& other) {
    return item.body < 0 ? 0
           : other.body < 0
               ? item.free.body.rotation(item.free.arm, normal) + item.free.body.translation(normal)
               : item.free.beside_mass(normal);
  };
  out.of_bodies = free(a, b) + free(b, a);
  return out;
}

// Every ordered pair and image: forces once per item, energies and counts half from either side.
BruteContacts brute_contacts(const LoadedBox& box) {
  const std::vector<BruteItem> items = brute_items(box);
  const TouchRule rule(box.model);
  BruteContacts sum{std::vector<Vec3>(items.size()), std::vector<int>(items.size()),
                    std::vector<Tensor>(items.size())};
  Real pairs = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    const BruteItem& a = items[i];
    for (std::size_t j = 0; j < items.size(); ++j)
      for_each_shift(Subdomain(box.model.space).period(), [&](Vec3 shift, int image) {
        const BruteItem& b = items[j];
        if ((i == j && image == kZeroShift) || !rule.may_touch(a.body, b.body)) return;
        const Vec3 r = a.position - b.position - shift;
        const Real overlap = a.radius + b.radius - norm(r);
        if (overlap <= 0) return;
        const Vec3 normal = (1 / norm(r)) * r;
        const NormalLawParameters& law = box.model.contact.law(a.material, b.material);
        const Real arm = norm(r) * a.radius / (a.radius + b.radius);
        add_contact(sum, law,
                    {overlap, -dot(normal, a.velocity - b.velocity), normal, arm, size_of(a, b, normal), 0.5},
                    i);
        pairs += 0.5;
      });
    for (const Wall& wall : box.model.walls) {
      const Real overlap = a.radius - dot(a.position - wall.point, wall.normal);
      if (overlap <= 0) continue;
      const NormalLawParameters& law = box.model.contact.law(a.material, wall.material);
      const PairSize size{a.radius, kInfinity, a.mass, kInfinity, a.free.beside_mass(wall.normal)};
      add_contact(sum, law,
                  {overlap, -dot(wall.normal, a.velocity), wall.normal, a.radius - overlap, size, 1}, i);
      pairs += 1;
    }
  }
  sum.count = static_cast<int>(std::lround(pairs));
  return sum;
}

}  // namespace

TEST_CASE("contact forces on particles and shapes are those of all pairs and walls") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    LoadedBox box(random_box(c, kParticles, 11));
    const BruteContacts expected = brute_contacts(box);
    REQUIRE(expected.count > 20);
    const BoxOutput output(*box.backend);
    for (std::size_t i = 0; i < output.all.global_id.size(); ++i) {
      const auto id = static_cast<std::size_t>(output.all.global_id[i]);
      CHECK(norm(output.of<Vec3>("force")[i] - expected.force[id]) <= kRoundOff * expected.magnitude);
      CHECK(output.of<int>("contacts")[i] == expected.contacts[id]);
      const Tensor &stress = output.of<Tensor>("stress")[i], &virial = expected.virial[id];
      const Real r = box.model.particles.radius[id];
      const Real volume =
          c.dimension == 2 ? std::numbers::pi * r * r : 4.0 / 3 * std::numbers::pi * r * r * r;
      const Real bound = kRoundOff * expected.magnitude * r;
      CHECK(norm(volume * stress.x - virial.x) <= bound);
      CHECK(norm(volume * stress.y - virial.y) <= bound);
      CHECK(norm(volume * stress.z - virial.z) <= bound);
    }
    const ShapePack shapes = box.backend->reports().pack_shapes();
    for (std::size_t s = 0; s < shapes.force.size(); ++s) {
      CHECK(norm(shapes.force[s] - expected.force[kParticles + s]) <= kRoundOff * expected.magnitude);
      CHECK(shapes.contacts[s] == expected.contacts[kParticles + s]);
    }
  }
}

TEST_CASE("the wrench on a body is the sum over its shapes, with their arms") {
  for (const BoxCase& c : kBoxes) {
    if (!c.bodies) continue;
    CAPTURE(c.name);
    LoadedBox box(random_box(c, kParticles, 12));
    const BruteContacts contacts = brute_contacts(box);
    std::vector<BodyWrench> end(box.motion.size());
    box.backend->particles().reduce_wrench(end);
    std::size_t item = kParticles;
    for (std::size_t b = 0; b < box.motion.size(); ++b) {
      Vec3 force, torque;
      for (const Shape& shape : box.model.bodies[b].shapes) {
        const Vec3 arm = point_motion(box.motion[b], shape.offset).position - box.motion[b].position;
        force += contacts.force[item], torque += cross(arm, contacts.force[item]);
        ++item;
      }
      CHECK(norm(end[b].force - force) <= kRoundOff * contacts.magnitude);
      CHECK(norm(end[b].torque - torque) <= kRoundOff * contacts.magnitude);
    }
  }
}

TEST_CASE("particles and bodies push each other with opposite forces and torques") {
  for (const BoxCase& c : kBoxes) {
    Model model = random_box(c, kParticles, 13);
    model.walls.clear();
    CAPTURE(c.name);
    LoadedBox box(model);
    Vec3 force, torque;
    Real magnitude = 0;
    const BoxOutput output(*box.backend);
    const std::vector<Vec3>& forces = output.of<Vec3>("force");
    for (std::size_t i = 0; i < forces.size(); ++i) {
      force += forces[i], torque += cross(output.all.position[i], forces[i]);
      magnitude += norm(forces[i]);
    }
    std::vector<BodyWrench> end(box.motion.size());
    box.backend->particles().reduce_wrench(end);
    for (std::size_t b = 0; b < end.size(); ++b) {
      force += end[b].force, torque += end[b].torque + cross(box.motion[b].position, end[b].force);
    }
    CHECK(norm(force) <= kRoundOff * magnitude);
    if (c.periodic_axes == 0) CHECK(norm(torque) <= kRoundOff * magnitude);  // images have other arms
  }
}

TEST_CASE("the ledger sums over all particles and contacts") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    LoadedBox box(random_box(c, kParticles, 14));
    const BruteContacts contacts = brute_contacts(box);
    Real kinetic = 0, gravitational = 0, scale = 0;
    Vec3 momentum, angular;
    for (std::size_t i = 0; i < kParticles; ++i) {
      const Particle& r = box.records[i];
      const Real mass = box.model.particles.mass[i];
      kinetic += mass / 2 * dot(r.velocity, r.velocity);
      gravitational -= mass * dot(box.model.gravity, r.position);
      scale += mass * norm(box.model.gravity) * norm(r.position);
      momentum += mass * r.velocity, angular += mass * cross(r.position, r.velocity);
    }
    const ParticleLedger ledger = box.backend->reports().ledger(0);
    CHECK(near(ledger.kinetic, kinetic, {.relative = kSum}));
    CHECK(near(ledger.gravitational, gravitational, {.absolute = kSum * scale}));
    CHECK(near(ledger.contact_elastic, contacts.elastic, {.relative = kSum}));
    CHECK(ledger.contacts == contacts.count);
    CHECK(norm(ledger.momentum - momentum) <= kRoundOff * kParticles);
    CHECK(norm(ledger.angular_momentum - angular) <= kRoundOff * kParticles);
    CHECK((ledger.contact_loss == 0 && ledger.integrator_loss == 0 && ledger.drifting == 0));
  }
}

TEST_CASE("the ledger adds what particles and shapes have lost so far, and Verlet's shift") {
  LoadedBox box(random_box(kBoxes[2], kParticles, 15));
  Real lost = 0, integrator = 0;
  for (std::size_t i = 0; i < box.records.size(); ++i) {
    box.records[i].contact_loss = 0.25 * static_cast<Real>(i), lost += box.records[i].contact_loss;
    box.records[i].integrator_loss = 2 - static_cast<Real>(i), integrator += box.records[i].integrator_loss;
    box.records[i].acceleration = {1, 2, 0};
  }
  box.records[3].drifting = true;
  box.backend->particles().load(box.records, {7, 0});
  box.backend->list().set_body_motion(box.motion);
  box.backend->list().build(0.02, box.timers);
  const ParticleLedger ledger = box.backend->reports().ledger(0);
  CHECK(ledger.contact_loss == lost + 7);
  CHECK(ledger.integrator_loss == integrator);
  CHECK(ledger.drifting == 1);
  Real mass = 0;
  for (const Real m : box.model.particles.mass) mass += m;
  const Real h = 0.01, shift = mass * h * h / 8 * 5;
  CHECK(near(box.backend->reports().ledger(h).integrator_loss, integrator - shift, {.relative = kSum}));
}

}  // namespace scree
