// Packed contact history, used while there is no list: from one list to the next, in migration, and in files.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "dem/history/history_content.hpp"
#include "dem/history/shape_contacts.hpp"
#include "model/data/model.hpp"
#include "partition/id_order.hpp"
#include "partition/ranks.hpp"

namespace scree {

// History content of a model whose law has `of_law` numbers per contact: these numbers, or `kSidesOnly`.
HistoryContent packed_content(const Model& model, int of_law);

// Contacts that were closed at the last step, particle by particle, without ghosts. The particles are stored
// elsewhere in the same order.
struct PackedHistory {
  HistoryContent content = kNoHistory;   // without history no particle has a row
  std::vector<std::int64_t> offsets{0};  // [particles + 1] into the contacts
  std::vector<std::int64_t> keys;        // [contacts], increasing in a row: contact keys (contact_key.hpp)
  std::vector<Real> values;              // [contacts][width()]

  int width() const { return content.values; }
  std::int64_t particles() const { return std::ssize(offsets) - 1; }
  std::int64_t contacts(std::int64_t particle) const {
    return offsets[static_cast<std::size_t>(particle) + 1] - offsets[static_cast<std::size_t>(particle)];
  }
  // Number of contacts of the particle with the surface of this number.
  Index contacts_with(std::int64_t particle, Index surface) const;
  std::span<const Real> values_of(std::int64_t contact) const {
    const auto n = static_cast<std::size_t>(width());
    return {values.data() + static_cast<std::size_t>(contact) * n, n};
  }
  // Number of contacts of each particle.
  std::vector<std::int64_t> counts() const;
  // Adds a contact to the open row; ends that row.
  void add(std::int64_t key, std::span<const Real> of_contact) {
    keys.push_back(key), values.insert(values.end(), of_contact.begin(), of_contact.end());
  }
  void end_row() { offsets.push_back(std::ssize(keys)); }
  // Sorts the contacts of the open row from this one on.
  void order_from(std::size_t contact);
  // Adds a row of another packed history.
  void add_row(const PackedHistory& from, std::int64_t particle);
  // Appends all rows of another packed history with the same numbers.
  void append(const PackedHistory& of_others);
  // Rows of these particles, in this order.
  PackedHistory rows(std::span<const Index> particles) const;
  // Contacts between particles only.
  PackedHistory without_surfaces() const;
  // Sets the offsets from counts().
  void set_counts(std::span<const std::int64_t> counts);
};

// Estimated memory of the history of a particle's contacts [B]: records at the slots of its row, and packed
// for those in contact in a dense packing.
double history_bytes(int numbers, double slots = 10);
// The estimate for the serial backend, whose explicit steps store records by pairs, too.
double history_bytes_with_pairs(int numbers);

// Packed history of particles without contacts.
PackedHistory no_contacts(HistoryContent content, std::int64_t particles);

// From the history of another law, where the model has the history `content`: the contacts with open
// surfaces, with their sides only.
PackedHistory sides_of(const PackedHistory& contacts, const Model& model, HistoryContent content);
ShapeContacts sides_of(const ShapeContacts& contacts, const Model& model, HistoryContent content);

// Rows in the order of the ids, like their particles. Collective.
PackedHistory in_order(const IdOrder& order, PackedHistory contacts);

// Sends to[r] to rank r; received rows are ordered by sender. Collective.
PackedHistory all_to_all(const Ranks& ranks, const std::vector<PackedHistory>& to);

}  // namespace scree
