// Contact histories on all ranks against one rank: with migrating particles, and from a checkpoint of any
// number of ranks to any other. (One rank against brute force: unit/dem.)
#include "output/checkpoint.hpp"
#include "support/catch.hpp"
#include "support/contact_record.hpp"
#include "support/history_test_box.hpp"
#include "support/particle_bits.hpp"
#include "support/petsc_run.hpp"
#include "support/shared_folder.hpp"

namespace scree {

namespace {

// The state of all ranks, on each rank.
State of_all(const HistoryTestBox& box) {
  const State own = box.in_id_order();
  State all;
  all.particles = box.ranks.all_gather(own.particles);
  all.contacts.content = own.contacts.content;
  all.contacts.set_counts(box.ranks.all_gather(own.contacts.counts()));
  all.contacts.keys = box.ranks.all_gather(own.contacts.keys);
  all.contacts.values = box.ranks.all_gather(own.contacts.values);
  return all;
}

void check_equal(const HistoryTestBox& one, const HistoryTestBox& many) {
  const State a = of_all(one), b = of_all(many);
  CHECK(differing_fields(a.particles, b.particles) == "");
  CHECK(difference(a.contacts, b.contacts) == "");
  CHECK(a.contacts.keys.size() > 5);
  CHECK(one.hash() == many.hash());
}

}  // namespace

TEST_CASE("contact histories over ranks, lists and cuts are those of one rank") {
  petsc();
  for (const BoxCase& c : kBoxes)
    for (const OutsidePolicy leaving : {OutsidePolicy::drift, OutsidePolicy::remove}) {
      CAPTURE(c.name, static_cast<int>(leaving));
      const Model model = moving_box(c, leaving);
      HistoryTestBox many(model, Ranks::world()), one(model, Ranks());
      for (HistoryTestBox* box : {&many, &one}) box->start();
      const auto migrated = [&] { return many.ranks.sum(many.backend->list().balance().migrated); };
      const std::int64_t at_start = migrated();
      for (int part = 0; part < 20; ++part) {
        for (HistoryTestBox* box : {&many, &one}) box->take_steps(1 + 2 * part);
        check_equal(one, many);
      }
      CHECK((migrated() > at_start) == !many.ranks.alone());
      CHECK(many.backend->list().builds() > 5);
    }
}

TEST_CASE("contact histories pass through a checkpoint to any number of ranks") {
  petsc();
  for (const BoxCase& c : kBoxes) {
    CAPTURE(c.name);
    const Model model = moving_box(c, OutsidePolicy::remove);
    const Ranks world = Ranks::world();
    HistoryTestBox many(model, world), one(model, Ranks());
    for (HistoryTestBox* box : {&many, &one}) box->start(), box->take_steps(100), box->take_steps(77);
    const SharedFolder folder(world);
    const State of_many = many.in_id_order(), of_one = one.in_id_order();
    write_checkpoint(folder / "many.h5", pack(of_many), world);
    world.on_root([&] { write_checkpoint(folder / "one.h5", pack(of_one)); });
    for (const char* name : {"many.h5", "one.h5"}) {
      CAPTURE(name);
      HistoryTestBox again(model, world), again_alone(model, Ranks());
      again.motion = again_alone.motion = many.motion;
      again.start(unpack(read_checkpoint(folder / name, world), world));
      again_alone.start(unpack(read_checkpoint(folder / name)));
      check_equal(one, again), check_equal(one, again_alone);
      HistoryTestBox onward(model, Ranks());
      onward.motion = one.motion, onward.start(of_one);
      for (HistoryTestBox* box : {&again, &again_alone, &onward}) box->take_steps(60);
      check_equal(onward, again), check_equal(onward, again_alone);
    }
  }
}

}  // namespace scree
