#include "dem/history/packed_history.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "dem/history/contact_key.hpp"
#include "dem/history/history_slots.hpp"
#include "dem/history/shape_contacts.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "mesh/surface_mesh.hpp"

namespace scree {
namespace {

// The contacts with the requested keys. Their values are zero unless `all` has the same content.
template <class IsRequested>
PackedHistory only(const PackedHistory& all, HistoryContent content, const IsRequested& is_requested) {
  PackedHistory out;
  out.content = content;
  const std::vector<Real> none(static_cast<std::size_t>(out.width()));
  for (std::int64_t i = 0; i < all.particles(); ++i) {
    for (std::int64_t c = all.offsets[static_cast<std::size_t>(i)];
         c < all.offsets[static_cast<std::size_t>(i) + 1]; ++c)
      if (const std::int64_t key = all.keys[static_cast<std::size_t>(c)]; is_requested(key))
        out.add(key, content == all.content ? all.values_of(c) : none);
    out.end_row();
  }
  return out;
}

// Recognizes contacts with open surfaces by their keys.
class OpenSurfaceKeys {
 public:
  explicit OpenSurfaceKeys(const Model& model) {
    const SurfaceSet surfaces(model);
    for (Index s = 0; s < surfaces.placed(); ++s) {
      const Surface& surface = surfaces.at(s);
      if (surface.kind == SurfaceKind::mesh &&
          model.meshes[static_cast<std::size_t>(surface.mesh)].surface->sheet)
        open_surfaces_.insert(surfaces.number_of(s));
    }
  }
  bool operator()(std::int64_t key) const {
    return is_surface(key) && open_surfaces_.count(surface_of(key)) > 0;
  }

 private:
  std::set<Index> open_surfaces_;
};

}  // namespace

HistoryContent packed_content(const Model& model, int of_law) {
  return of_law == 0 && has_open_surfaces(model) ? kSidesOnly : HistoryContent::of_law(of_law);
}

namespace {

// Number of contacts with the surface of this number.
Index count_with(std::span<const std::int64_t> keys, Index surface) {
  return static_cast<Index>(
      std::ranges::count_if(keys, [&](std::int64_t key) { return is_with_surface(key, surface); }));
}

}  // namespace

Index PackedHistory::contacts_with(std::int64_t particle, Index surface) const {
  const auto first = static_cast<std::size_t>(offsets[static_cast<std::size_t>(particle)]);
  return count_with({keys.data() + first, static_cast<std::size_t>(contacts(particle))}, surface);
}

Index ShapeContacts::contacts_with(std::int64_t shape, Index surface) const {
  const auto of_shape = std::ranges::equal_range(shapes, shape);
  const auto first = static_cast<std::size_t>(of_shape.begin() - shapes.begin());
  return count_with({keys.data() + first, of_shape.size()}, surface);
}

void PackedHistory::add_row(const PackedHistory& from, std::int64_t particle) {
  const auto row = static_cast<std::size_t>(particle);
  for (std::int64_t k = from.offsets[row]; k < from.offsets[row + 1]; ++k)
    add(from.keys[static_cast<std::size_t>(k)], from.values_of(k));
  end_row();
}

void PackedHistory::order_from(std::size_t contact) {
  const auto n = static_cast<std::size_t>(width());
  sort_by_key(
      contact, keys.size(), [this](std::size_t k) { return keys[k]; },
      [&](std::size_t a, std::size_t b) {
        std::swap(keys[a], keys[b]);
        std::swap_ranges(values.data() + a * n, values.data() + (a + 1) * n, values.data() + b * n);
      });
}

void PackedHistory::append(const PackedHistory& of_others) {
  const std::int64_t before = std::ssize(keys);
  for (std::int64_t i = 1; i <= of_others.particles(); ++i)
    offsets.push_back(before + of_others.offsets[static_cast<std::size_t>(i)]);
  keys.insert(keys.end(), of_others.keys.begin(), of_others.keys.end());
  values.insert(values.end(), of_others.values.begin(), of_others.values.end());
}

PackedHistory PackedHistory::rows(std::span<const Index> particles) const {
  PackedHistory out;
  out.content = content;
  out.offsets.reserve(particles.size() + 1);
  for (const Index particle : particles) out.add_row(*this, particle);
  return out;
}

std::vector<std::int64_t> PackedHistory::counts() const {
  std::vector<std::int64_t> counts;
  counts.reserve(offsets.size());
  for (std::int64_t i = 0; i < particles(); ++i) counts.push_back(contacts(i));
  return counts;
}

void PackedHistory::set_counts(std::span<const std::int64_t> counts) {
  offsets.assign(1, 0);
  for (const std::int64_t count : counts) offsets.push_back(offsets.back() + count);
}

double history_bytes(int numbers, double slots) {
  constexpr double kTouching = 6;
  if (numbers <= 0) return 0;
  return slots * records_of(numbers) * static_cast<double>(sizeof(Vec4)) +
         kTouching * (sizeof(std::int64_t) + static_cast<double>(numbers) * sizeof(Real));
}

double history_bytes_with_pairs(int numbers) {
  constexpr double kPairs = 5;  // with two slots each
  return history_bytes(numbers) + kPairs * records_of(numbers) * static_cast<double>(sizeof(Vec4));
}

PackedHistory PackedHistory::without_surfaces() const {
  return only(*this, content, [](std::int64_t key) { return !is_surface(key); });
}

PackedHistory sides_of(const PackedHistory& contacts, const Model& model, HistoryContent content) {
  return only(contacts, content, OpenSurfaceKeys(model));
}

ShapeContacts sides_of(const ShapeContacts& contacts, const Model& model, HistoryContent content) {
  const OpenSurfaceKeys is_of_open_surface(model);
  ShapeContacts out;
  out.content = content;
  for (std::size_t k = 0; k < contacts.keys.size(); ++k)
    if (is_of_open_surface(contacts.keys[k]))
      out.shapes.push_back(contacts.shapes[k]), out.keys.push_back(contacts.keys[k]);
  out.values.resize(out.keys.size() * static_cast<std::size_t>(out.width()));
  return out;
}

PackedHistory no_contacts(HistoryContent content, std::int64_t particles) {
  PackedHistory out;
  out.content = content;
  if (content.exists()) out.offsets.assign(static_cast<std::size_t>(particles) + 1, 0);
  return out;
}

PackedHistory all_to_all(const Ranks& ranks, const std::vector<PackedHistory>& to) {
  std::vector<std::vector<std::int64_t>> counts, keys;
  std::vector<std::vector<Real>> values;
  PackedHistory arriving;
  for (const PackedHistory& part : to) {
    arriving.content = part.content;
    counts.push_back(part.counts()), keys.push_back(part.keys), values.push_back(part.values);
  }
  arriving.set_counts(ranks.all_to_all(counts));
  arriving.keys = ranks.all_to_all(keys), arriving.values = ranks.all_to_all(values);
  return arriving;
}

PackedHistory in_order(const IdOrder& order, PackedHistory contacts) {
  if (!contacts.content.exists()) return contacts;
  const std::vector<std::int64_t> counts = contacts.counts();
  std::vector<std::int64_t> of_values = counts;
  for (std::int64_t& count : of_values) count *= contacts.width();
  contacts.keys = order.apply(std::move(contacts.keys), counts);
  contacts.values = order.apply(std::move(contacts.values), std::move(of_values));
  contacts.set_counts(order.apply(counts));
  return contacts;
}

}  // namespace scree
