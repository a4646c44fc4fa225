#include "run/record/constant_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <vector>

#include "dem/particles/particle_fields.hpp"

namespace scree {

std::string constant_fields(const Model& model) {
  std::vector<std::string> still;
  const std::vector<std::string>& wanted = model.output.fields;
  for_each_field([&](const ParticleField& field, auto) {
    if ((field.parts & kRotation) == 0 || model.rotates()) return;
    if (std::ranges::find(wanted, field.name) != wanted.end()) still.emplace_back(field.name);
  });
  if (still.empty()) return "";
  return fmt::format(
      "output.fields: {} will be the same in all snapshots: no particle rotates because no pair in "
      "contact.pairs has friction",
      fmt::join(still, ", "));
}

}  // namespace scree
