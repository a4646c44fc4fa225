#include "run/state/contact_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/index.hpp"
#include "dem/history/contact_key.hpp"

namespace scree {
namespace {

constexpr const char* kHistory = "contacts/history";

// Contacts that store their side alone have other names for these rows, so that a file without the history is
// refused.
struct RowNames {
  const char *counts, *partners, *images;
};
constexpr RowNames kOfContacts{"contacts/count", "contacts/partner", "contacts/image"},
    kOfSides{"sides/count", "sides/partner", "sides/image"};

const RowNames& names_of(const PackedHistory& contacts) {
  return contacts.content == kSidesOnly ? kOfSides : kOfContacts;
}

// Adds a dataset of rows with one integer each.
template <class Number>
void add_integers(const char* name, const char* description, std::int64_t rows, const Number& number,
                  Checkpoint& out) {
  const auto copy = [number](std::int64_t first, std::int64_t count, std::int64_t* to) {
    for (std::int64_t k = first; k < first + count; ++k) *to++ = number(k);
  };
  out.integer_rows[name] = {1, rows, copy, "1", description};
}

template <class T>
std::vector<T> read_rows(const CheckpointRows<T>& rows, std::int64_t first, std::int64_t count) {
  std::vector<T> values(as_size(count * rows.width));
  if (count > 0) rows.copy(first, count, values.data());
  return values;
}

// Reads the rows of this rank's contacts. below_own, below_rows: contacts of the particles of the ranks
// below, and rows that those ranks read.
void read_contacts(const Checkpoint& in, std::int64_t below_own, std::int64_t below_rows,
                   PackedHistory& contacts) {
  const RowNames& names = names_of(contacts);
  const std::int64_t first = below_own - below_rows, count = contacts.offsets.back();
  const auto partners = read_rows(in.row_array<std::int64_t>(names.partners), first, count),
             images = read_rows(in.row_array<std::int64_t>(names.images), first, count);
  for (std::size_t k = 0; k < partners.size(); ++k) {
    if (partners[k] < 0 || partners[k] >= kPartnersEnd || images[k] < 0 || images[k] >= kImages)
      throw IoError(in.path + ": the partner or the image of a contact is not valid");
    contacts.keys.push_back(row_key(partners[k], static_cast<std::int8_t>(images[k])));
  }
  if (contacts.width() > 0) contacts.values = read_rows(in.row_array<Real>(kHistory), first, count);
}

}  // namespace

void add_contacts(const PackedHistory& contacts, Checkpoint& out) {
  if (!contacts.content.exists()) return;
  const RowNames& names = names_of(contacts);
  const std::int64_t count = std::ssize(contacts.keys);
  const auto key = [&contacts](std::int64_t k) { return contacts.keys[as_size(k)]; };
  add_integers(
      names.counts, "contacts of each particle, in the order of the particles", contacts.particles(),
      [&contacts](std::int64_t i) { return contacts.contacts(i); }, out);
  add_integers(
      names.partners,
      "of each contact: id of the other particle; or 2^48 plus the number of the surface, plus 2^20 times "
      "the number of the mesh feature, plus 2^49 if the centre has penetrated an open surface",
      count, [key](std::int64_t k) { return id_of(key(k)); }, out);
  add_integers(
      names.images, "image of the partner: 13 plus the periods in x, 3 times those in y, 9 times those in z",
      count, [key](std::int64_t k) { return image_of(key(k)); }, out);
  const int numbers = contacts.width();
  if (numbers == 0) return;
  out.real_rows[kHistory] = {numbers, count,
                             [&contacts, numbers](std::int64_t first, std::int64_t rows, Real* to) {
                               std::copy_n(contacts.values.begin() + first * numbers, rows * numbers, to);
                             },
                             "of the law", "history of the contact, as seen from this particle"};
}

HistoryContent content_in(const Checkpoint& checkpoint) {
  const auto history = checkpoint.real_rows.find(kHistory);
  if (history != checkpoint.real_rows.end()) return HistoryContent::of_law(history->second.width);
  return checkpoint.integer_rows.count(kOfSides.counts) > 0 ? kSidesOnly : kNoHistory;
}

PackedHistory unpack_contacts(const Checkpoint& in, const Ranks& ranks) {
  PackedHistory contacts;
  contacts.content = content_in(in);
  if (!contacts.content.exists()) return contacts;
  const RowNames& names = names_of(contacts);
  const std::int64_t rows = in.row_array<std::int64_t>(names.partners).count, all = ranks.sum(rows);
  ranks.collectively([&] {
    const CheckpointRows<std::int64_t>& counts = in.row_array<std::int64_t>(names.counts);
    contacts.set_counts(read_rows(counts, 0, counts.count));
    for (const std::int64_t count : contacts.counts())
      if (count < 0 || count > all)
        throw IoError(in.path + ": the number of contacts of a particle is not valid");
  });
  const std::int64_t own = contacts.offsets.back(), below = ranks.sum_below(own),
                     below_rows = ranks.sum_below(rows);
  const bool has_values = contacts.width() > 0;
  if (ranks.sum(own) != all || (has_values && ranks.sum(in.row_array<Real>(kHistory).count) != all) ||
      ranks.sum(in.row_array<std::int64_t>(names.images).count) != all)
    throw IoError(in.path + ": the contacts' arrays do not fit together");
  ranks.collectively([&] { read_contacts(in, below, below_rows, contacts); });
  return contacts;
}

void add_contacts(const PackedHistory& contacts, std::size_t particle, BitHash& hash) {
  for (std::int64_t k = contacts.offsets[particle]; k < contacts.offsets[particle + 1]; ++k) {
    // Without a history the side follows from the centre, unless the centre has penetrated the surface.
    if (contacts.content == kSidesOnly && !is_penetrated(contacts.keys[as_size(k)])) continue;
    hash.add(contacts.keys[as_size(k)]);
    for (const Real value : contacts.values_of(k)) hash.add(value);
  }
}

std::string contacts_error(const PackedHistory& contacts, const std::vector<Particle>& particles,
                           std::int64_t of_deck) {
  if (!contacts.content.exists()) return "";
  if (contacts.particles() != std::ssize(particles)) return "the contacts are of another number of particles";
  for (std::size_t i = 0; i < particles.size(); ++i)
    for (std::int64_t k = contacts.offsets[i]; k < contacts.offsets[i + 1]; ++k) {
      const GlobalId id = particles[i].global_id;
      const std::int64_t key = contacts.keys[as_size(k)];
      if (k > contacts.offsets[i] && contacts.keys[as_size(k) - 1] >= key)
        return fmt::format("the contacts of particle {} are out of order", id);
      if (id_of(key) >= of_deck && id_of(key) < kFirstSurfaceId)
        return fmt::format("a contact of particle {} is with particle {}; the deck has {}", id, id_of(key),
                           of_deck);
      for (const Real value : contacts.values_of(k))
        if (!std::isfinite(value)) return fmt::format("a contact of particle {} is not finite", id);
    }
  return "";
}

}  // namespace scree
