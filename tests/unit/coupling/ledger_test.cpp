// Bookkeeping of what leaves, and of energy that changes its place.
#include "coupling/ledger.hpp"

#include <algorithm>

#include "support/catch.hpp"

namespace scree {

namespace {

const std::vector<Leaver> kLeavers = {{3, 0, {1, 2, 0}, false, 10, 0.5, 0.25, {{0.25, 0.125, 0.0625}}, 2},
                                      {8, 0, {1, 3, 0}, false, -4, 0.25, -0.125, {{0.125, 0, 0}}, 0}};

}  // namespace

TEST_CASE("removed particles take their energies along, drifting ones that of their contacts") {
  CarriedOut removed, drifting;
  for (int twice = 0; twice < 2; ++twice) {
    book_leavers(kLeavers, Leaving::remove, removed);
    book_leavers(kLeavers, Leaving::drift, drifting);
  }
  CHECK((removed.left == 4 && removed.removed == 4));
  CHECK((removed.energy == 16 && removed.contact_loss == 1.5 && removed.integrator_loss == 0.25));
  CHECK(removed.losses == RubbingLosses{{0.75, 0.25, 0.125}});
  CHECK((drifting.left == 4 && drifting.removed == 0));
  CHECK((drifting.energy == 4 && drifting.contact_loss == 0 && drifting.integrator_loss == 0));
}

TEST_CASE("removing a particle leaves the balance as it was") {
  ParticleLedger before;
  before.kinetic = 30, before.gravitational = -7, before.contact_elastic = 2;
  before.contact_loss = 4, before.integrator_loss = 1;
  const Ledger with = make_ledger(before, {}, nullptr, {}, 0);
  CHECK((with.mechanical() == 25 && with.accounted() == 30));

  CarriedOut carried;
  book_leavers(kLeavers, Leaving::remove, carried);
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

TEST_CASE("energy exchanged is what has left one entry for another") {
  Ledger before, after;
  before.kinetic = 10, after.kinetic = 4;
  after.elastic_contacts = 5, after.dissipated_contacts = 1;
  CHECK(energy_exchanged(before, after) == 6);
  CHECK(energy_exchanged(after, before) == 6);
  CHECK(energy_exchanged(after, after) == 0);
}

}  // namespace scree
