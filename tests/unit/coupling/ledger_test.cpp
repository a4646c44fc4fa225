// Energy accounting of escaped particles, and of conversions between entries.
#include "coupling/ledger.hpp"

#include <algorithm>

#include "support/catch.hpp"

namespace scree {

namespace {

const std::vector<EscapedParticle> kEscaping = {
    {3, 0, {1, 2, 0}, false, 10, 0.5, 0.25, {{0.25, 0.125, 0.0625}}, 2},
    {8, 0, {1, 3, 0}, false, -4, 0.25, -0.125, {{0.125, 0, 0}}, 0}};

}  // namespace

TEST_CASE("removed particles take all their energy along, ballistic ones the energy of their contacts") {
  CarriedOut removed, drifting;
  for (int twice = 0; twice < 2; ++twice) {
    account_escaped(kEscaping, OutsidePolicy::remove, removed);
    account_escaped(kEscaping, OutsidePolicy::drift, drifting);
  }
  CHECK((removed.left == 4 && removed.removed == 4));
  CHECK((removed.energy == 16 && removed.contact_loss == 1.5 && removed.integrator_loss == 0.25));
  CHECK(removed.losses == TangentialLosses{{0.75, 0.25, 0.125}});
  CHECK((drifting.left == 4 && drifting.removed == 0));
  CHECK((drifting.energy == 4 && drifting.contact_loss == 0 && drifting.integrator_loss == 0));
  CHECK((drifting.ballistic_energy == 12 && drifting.ballistic_integrator_loss == 0.25));
  CHECK((removed.ballistic_energy == 0 && removed.ballistic_integrator_loss == 0));
}

TEST_CASE("removing a particle leaves the balance as it was") {
  ParticleLedger before;
  before.kinetic = 30, before.gravitational = -7, before.contact_elastic = 2;
  before.contact_loss = 4, before.integrator_loss = 1;
  const Ledger with = make_ledger(before, {}, nullptr, {}, 0);
  CHECK((with.mechanical() == 25 && with.accounted() == 30));

  CarriedOut carried;
  account_escaped(kEscaping, OutsidePolicy::remove, carried);
  ParticleLedger after = before;
  after.kinetic -= 6, after.contact_elastic -= 2, after.contact_loss -= carried.contact_loss;
  after.integrator_loss -= carried.integrator_loss;
  const Ledger without = make_ledger(after, carried, nullptr, {}, 0);
  CHECK(without.carried_out == 8);
  CHECK(without.accounted() == with.accounted());
}

TEST_CASE("every entry is accounted for once; the drivers' work counts against the rest") {
  const Ledger ledger{1, 20, 300, 4000, 5, 60, 700, 8000, 9};
  CHECK(ledger.mechanical() == 4321);
  CHECK(ledger.accounted() == 4321 + 5 + 60 + 700 + 9 - 8000);
  const auto entries = ledger.entries();
  for (const Real entry : {1, 20, 300, 4000, 5, 60, 700, 8000, 9})
    CHECK(std::count(entries.begin(), entries.end(), entry) == 1);
}

TEST_CASE("inside the domain the ledger is that of a run which removes the ballistic particles") {
  ParticleLedger before;
  before.kinetic = 30, before.gravitational = -7, before.contact_elastic = 2, before.contact_loss = 4;
  before.integrator_loss = 1, before.inside = {30, -7, 1};
  CHECK(inside_ledger(make_ledger(before, {}, nullptr, {}, 0), before, {}).entries() ==
        make_ledger(before, {}, nullptr, {}, 0).entries());

  // The escaped particles have 10 J and -4 J, and continue to fall.
  ParticleLedger removed = before, drifting = before;
  removed.kinetic = 20, removed.gravitational = -3, removed.contact_elastic = 0;
  removed.contact_loss = 4 - 0.75, removed.integrator_loss = 1 - 0.125;
  removed.inside = {20, -3, 1 - 0.125};
  drifting.kinetic = 20 + 1000, drifting.gravitational = -3 - 994, drifting.contact_elastic = 0;
  drifting.integrator_loss = 1 + 0.5, drifting.inside = removed.inside;
  const auto ledger = [](const ParticleLedger& particles, OutsidePolicy policy) {
    CarriedOut carried_out;
    account_escaped(kEscaping, policy, carried_out);
    return inside_ledger(make_ledger(particles, carried_out, nullptr, {}, 0), particles, carried_out);
  };
  const Ledger one = ledger(removed, OutsidePolicy::remove), other = ledger(drifting, OutsidePolicy::drift);
  CHECK(one.entries() == other.entries());
  CHECK(one.accounted() == make_ledger(before, {}, nullptr, {}, 0).accounted());
}

}  // namespace scree
