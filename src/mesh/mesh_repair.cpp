#include "mesh/mesh_repair.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "mesh/degenerate_triangles.hpp"
#include "mesh/duplicate_triangles.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/windings.hpp"

namespace scree {

namespace {

// The number of original triangles among these; one that was split counts once.
std::size_t count_given(std::vector<Index> numbers) {
  std::ranges::sort(numbers);
  return static_cast<std::size_t>(std::unique(numbers.begin(), numbers.end()) - numbers.begin());
}

// The repaired triangles of one kind. numbers: increasing, of triangles of the original mesh.
RepairedTriangles noted(const NumberedMesh& given, const std::vector<Index>& numbers) {
  if (numbers.empty()) return {};
  const auto first = std::ranges::find(given.numbers, numbers.front()) - given.numbers.begin();
  return {count_given(numbers), triangle_text(given.mesh, static_cast<Index>(first), numbers.front())};
}

// Whether squares of areas are finite.
bool has_products(Vec3 v) {
  constexpr Real kMost = 1e75;
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) < kMost;
}

std::string triangles(std::size_t count) {
  return count == 1 ? "1 triangle" : fmt::format("{} triangles", count);
}
const char* is_or_are(std::size_t count) { return count == 1 ? "is" : "are"; }

std::string reoriented_text(const MeshRepair& repair, bool sheet) {
  const auto& [count, first] = repair.turned;
  if (sheet)
    return fmt::format(
        "{} of its {} triangles {} wound against the others, which a sheet may be: it is touched from both "
        "sides (the first: {})",
        count, repair.left, is_or_are(count), first);
  if (count == repair.left)
    return fmt::format(
        "all of its {} triangles ran clockwise seen from outside and are turned (the first: {}): it is a "
        "solid, with contacts from outside only; sheet = true makes a container of it",
        count, first);
  return fmt::format(
      "{} of its {} triangles {} turned, so that all run counterclockwise seen from outside (the first: {})",
      count, repair.left, is_or_are(count), first);
}

}  // namespace

MeshRepair repaired(NumberedMesh mesh, bool sheet) {
  MeshRepair repair{std::move(mesh), {}, {}, {}, 0};
  NumberedMesh& now = repair.mesh;
  if (!std::ranges::all_of(now.mesh.vertices, has_products)) return repair;
  const NumberedMesh given = now;
  repair.without_area = noted(given, remove_degenerate(now));
  repair.twins = noted(given, remove_duplicates(now, sheet));
  // Removes vertices that no triangle uses any more.
  if (repair.without_area.count + repair.twins.count > 0) now.mesh = welded(now.mesh);
  repair.turned = noted(given, sheet ? orient_consistently(now) : orient_outward(now));
  repair.left = count_given(now.numbers);
  return repair;
}

std::string repair_text(const MeshRepair& repair, bool sheet) {
  std::vector<std::string> texts;
  if (const auto& [count, first] = repair.without_area; count > 0)
    texts.push_back(fmt::format(
        "{} without area {} left out, and their neighbours are connected across them (the first: {})",
        triangles(count), is_or_are(count), first));
  if (const auto& [count, first] = repair.twins; count > 0)
    texts.push_back(fmt::format("{} with the corners of others {} left out (the first: {})", triangles(count),
                                is_or_are(count), first));
  if (repair.turned.count > 0) texts.push_back(reoriented_text(repair, sheet));
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace scree
