// Reports of one instant query the contacts with bodies once, with the same results as separate queries.
#include <numeric>

#include "random_box.hpp"
#include "support/catch.hpp"

namespace scree {
namespace {

// Counts the queries.
class CountedReports : public Reports {
 public:
  ParticleLedger ledger(Real) override {
    need_loads();
    return {};
  }
  void start_output() override { need_loads(); }
  ParticleOutput output() override { return {}; }
  ShapePack pack_shapes() override {
    need_loads();
    return {};
  }
  ContactLines contact_lines() override { return {}; }
  RegionSums in_region(const RegionBounds&) override { return {}; }
  std::vector<TracedParticle> traced(std::span<const GlobalId>) override { return {}; }
  std::vector<ContactSum> parent_contacts() override { return {}; }
  std::vector<ContactSum> surface_contacts() override { return {}; }
  std::vector<ContactSum> wall_contacts(std::span<const int>) override { return {}; }
  std::vector<TriangleLoad> triangle_loads() override { return {}; }

  int queries = 0;

 private:
  void find_loads() override { ++queries; }
};

struct Reported {
  ParticleLedger ledger;
  ShapePack shapes;
  std::vector<ContactSum> contacts;  // on bodies, then on walls
};

Reported tell(Reports& reports, const std::vector<int>& walls) {
  Reported reported{reports.ledger(0), reports.pack_shapes(), reports.parent_contacts()};
  for (const ContactSum& wall : reports.wall_contacts(walls)) reported.contacts.push_back(wall);
  return reported;
}

void check_same(const Reported& a, const Reported& b) {
  CHECK((a.ledger.contact_elastic == b.ledger.contact_elastic && a.ledger.contacts == b.ledger.contacts));
  CHECK((a.shapes.force == b.shapes.force && a.shapes.contacts == b.shapes.contacts));
  REQUIRE(a.contacts.size() == b.contacts.size());
  for (std::size_t k = 0; k < a.contacts.size(); ++k) {
    CHECK((a.contacts[k].force == b.contacts[k].force && a.contacts[k].torque == b.contacts[k].torque));
    CHECK(a.contacts[k].contacts == b.contacts[k].contacts);
  }
}

}  // namespace

TEST_CASE("reports query the contacts with bodies once per instant") {
  CountedReports reports;
  reports.ledger(0), reports.pack_shapes();
  CHECK(reports.queries == 2);
  {
    const Reports::Instant now(reports);
    reports.ledger(0), reports.start_output();
    {
      const Reports::Instant same(reports);
      reports.pack_shapes();
    }
    reports.pack_shapes();
    CHECK(reports.queries == 3);
  }
  reports.ledger(0), reports.ledger(0);
  CHECK(reports.queries == 5);
  const Reports::Instant later(reports);
  reports.ledger(0);
  CHECK(reports.queries == 6);
}

TEST_CASE("reports of one instant are those taken one by one, also after steps") {
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    LoadedBox box(random_box(c, 120, 17), 0.2);
    std::vector<int> walls(box.model.walls.size());
    std::iota(walls.begin(), walls.end(), 0);
    Reports& reports = box.backend->reports();
    std::vector<Real> elastic;
    for (int k = 0; k < 3; ++k) {
      Reported one_by_one = tell(reports, walls), together;
      {
        const Reports::Instant now(reports);
        together = tell(reports, walls);
      }
      check_same(one_by_one, together);
      elastic.push_back(together.ledger.contact_elastic);
      hht_step(*box.backend, box.motion, 2e-4);
    }
    CHECK((elastic[0] != elastic[1] && elastic[1] != elastic[2]));
  }
}

}  // namespace scree
