// The contact lines of backends, compared bit for bit.
#pragma once

#include <utility>
#include <vector>

#include "dem/backend/reports.hpp"
#include "partition/id_order.hpp"
#include "support/bits.hpp"

namespace scree {

inline auto fields(const ShownContact& c) {
  const auto& [branch, force, normal_force, tangential_force, overlap, slip] = c;
  return std::tie(branch, force, normal_force, tangential_force, overlap, slip);
}
inline auto fields(const ContactLine& line) {
  const auto& [first, second, start, contact] = line;
  return std::tie(first, second, start, contact);
}

// Lines of one rank, which has all particles of so many ids, in the order of the first particles.
inline std::vector<ContactLine> ordered_lines(Reports& reports, std::int64_t particles) {
  ContactLines lines = reports.contact_lines();
  const IdOrder order({}, particles, lines.global_id);
  return order.apply(std::move(lines.lines), std::move(lines.counts));
}

}  // namespace scree
