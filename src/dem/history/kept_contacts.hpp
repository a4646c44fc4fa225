// What contacts remember while there is no list: on its way from one list to the next, to another rank, to a
// file.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "dem/history/shape_contacts.hpp"
#include "model/data/model.hpp"
#include "partition/id_order.hpp"
#include "partition/ranks.hpp"

namespace scree {

// KeptContacts::numbers where the law remembers nothing, but contacts with sheets keep their sides: those
// alone are kept, and their names tell all.
inline constexpr int kSidesAlone = -1;
// What contacts of the model keep where their law remembers so many numbers: these, or kSidesAlone.
int kept_numbers(const Model& model, int of_law);

// The contacts that were closed at the last step, particle by particle; ghosts have none. The particles
// themselves stand elsewhere, in the same order.
struct KeptContacts {
  int numbers = 0;  // per contact; 0: nothing is remembered, and no particle has a row; or kSidesAlone
  std::vector<std::int64_t> offsets{0};  // [particles + 1] into the contacts
  std::vector<std::int64_t> keys;        // [contacts], increasing in a row: the partner (history_slots.hpp)
  std::vector<Real> values;              // [contacts][width()]

  int width() const { return numbers > 0 ? numbers : 0; }
  std::int64_t particles() const { return std::ssize(offsets) - 1; }
  std::int64_t contacts(std::int64_t particle) const {
    return offsets[static_cast<std::size_t>(particle) + 1] - offsets[static_cast<std::size_t>(particle)];
  }
  // Of these, with the surface of this number.
  Index contacts_with(std::int64_t particle, Index surface) const;
  std::span<const Real> values_of(std::int64_t contact) const {
    const auto n = static_cast<std::size_t>(width());
    return {values.data() + static_cast<std::size_t>(contact) * n, n};
  }
  // Per particle.
  std::vector<std::int64_t> counts() const;
  // A contact of the particle whose row is open, and the end of that row.
  void add(std::int64_t key, std::span<const Real> of_contact) {
    keys.push_back(key), values.insert(values.end(), of_contact.begin(), of_contact.end());
  }
  void end_row() { offsets.push_back(std::ssize(keys)); }
  // Orders the contacts of the open row from this one on.
  void order_from(std::size_t contact);
  // Adds the row of a particle of another set.
  void add_row(const KeptContacts& from, std::int64_t particle);
  // Adds the rows of other particles, which remember as much.
  void append(const KeptContacts& of_others);
  // The rows of these particles, in this order.
  KeptContacts rows(std::span<const Index> particles) const;
  // Of contacts between particles alone.
  KeptContacts without_surfaces() const;
  // From counts(): the offsets.
  void set_counts(std::span<const std::int64_t> counts);
};

// What the contacts of a particle remember takes in memory [B], estimated: at the slots of its row, of so
// many neighbours, and by name of those that touch in a dense packing.
double bytes_remembered(int numbers, double slots = 10);
// The same in the serial backend, whose explicit steps have it by pairs, too.
double bytes_remembered_with_pairs(int numbers);

// No particle of so many has a contact.
KeptContacts no_contacts(int numbers, std::int64_t particles);

// Of contacts that remember something of another law, where the model's law remembers `numbers`: those with
// sheets, which keep their sides and nothing else.
KeptContacts sides_of(const KeptContacts& contacts, const Model& model, int numbers);
ShapeContacts sides_of(const ShapeContacts& contacts, const Model& model, int numbers);

// In the order of the ids, like the particles whose rows they are. Collective.
KeptContacts in_order(const IdOrder& order, KeptContacts contacts);

// Sends to[r] to rank r; the rows of what arrives follow each other in the order of the senders. Collective.
KeptContacts deal_out(const Ranks& ranks, const std::vector<KeptContacts>& to);

}  // namespace scree
