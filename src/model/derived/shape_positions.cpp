#include "model/derived/shape_positions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "deck/suggestion.hpp"

namespace scree {

namespace {

constexpr std::int64_t kMostShapes = 10000000;  // of one entry
constexpr std::array<const char*, 3> kAxes = {"x", "y", "z"};

}  // namespace

ShapePositions::ShapePositions(const DeckTable& shape, int dimension) : first_(shape.vector("offset")) {
  if (shape.has("count") && shape.has("size")) shape.fail("size", "not used together with count");
  const bool several = shape.has("count") || shape.has("size");
  if (!several && shape.has("spacing"))
    shape.fail("spacing", "a single shape has no spacing; give count for a row or size for an array");
  if (several && !shape.has("spacing"))
    shape.fail("spacing", "missing; rows and arrays of shapes need the distance from each to the next");
  if (shape.has("count")) read_row(shape);
  if (shape.has("size")) read_array(shape, dimension);
  if (shape.has("sides")) read_sides(shape, dimension);
}

void ShapePositions::read_row(const DeckTable& shape) {
  size_[0] = shape.integer("count"), step_[0] = shape.vector("spacing");
  if (size_[0] > 1 && norm(step_[0]) == 0) shape.fail("spacing", "must not be 0");
}

void ShapePositions::read_array(const DeckTable& shape, int dimension) {
  const std::vector<std::int64_t>& size = shape.integers("size");
  if (std::ssize(size) != dimension) shape.fail("size", fmt::format("must have {} entries", dimension));
  const Vec3 spacing = shape.vector("spacing");
  const std::array<Real, 3> along = {spacing.x, spacing.y, spacing.z};
  std::int64_t places = 1;
  for (std::size_t axis = 0; axis < size.size(); ++axis) {
    size_[axis] = size[axis];
    if (size[axis] > kMostShapes / places)
      shape.fail("size", fmt::format("must have at most {} places", kMostShapes));
    places *= size[axis];
    if (size[axis] > 1 && !(along[axis] > 0))
      shape.fail("spacing",
                 fmt::format("must be above 0 along {}, where there are {} shapes", kAxes[axis], size[axis]));
  }
  step_ = {Vec3{spacing.x, 0, 0}, Vec3{0, spacing.y, 0}, Vec3{0, 0, spacing.z}};
}

void ShapePositions::read_sides(const DeckTable& shape, int dimension) {
  if (!shape.has("size")) shape.fail("sides", "needs size: an array has sides, a row or a single shape none");
  const std::vector<std::string> known(kSideNames.begin(), kSideNames.begin() + 2 * dimension);
  all_ = false;
  for (const std::string& name : shape.texts("sides")) {
    const auto side = std::ranges::find(known, name);
    if (side == known.end())
      shape.fail("sides", fmt::format("there is no side \"{}\"{}", name, suggestion(name, known)));
    bool& is_kept = sides_[static_cast<std::size_t>(side - known.begin())];
    if (is_kept)
      shape.fail("sides", fmt::format("\"{}\" is repeated; every entry must be another one", name));
    is_kept = true;
  }
  if (std::ranges::find(sides_, true) == sides_.end())
    shape.fail("sides", fmt::format("must name one side at least: {}", fmt::join(known, ", ")));
}

std::int64_t ShapePositions::count() const {
  std::int64_t places = 1, inside = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    places *= size_[axis];
    const std::int64_t kept = int{sides_[2 * axis]} + int{sides_[2 * axis + 1]};
    inside *= std::max<std::int64_t>(size_[axis] - kept, 0);
  }
  return all_ ? places : places - inside;
}

bool ShapePositions::is_kept(const Number& number) const {
  for (std::size_t axis = 0; axis < 3 && !all_; ++axis)
    if ((sides_[2 * axis] && number[axis] == 0) || (sides_[2 * axis + 1] && number[axis] == size_[axis] - 1))
      return true;
  return all_;
}

Vec3 ShapePositions::place(const Number& number) const {
  Vec3 place = first_;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (number[axis] > 0) place += static_cast<Real>(number[axis]) * step_[axis];
  return place;
}

std::vector<Vec3> ShapePositions::corners() const {
  std::vector<Vec3> corners;
  for (int corner = 0; corner < 8; ++corner) {
    Number number{};
    bool is_new = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool last = (corner >> axis & 1) != 0;
      if (last) number[axis] = size_[axis] - 1, is_new = is_new && size_[axis] > 1;
    }
    if (is_new && is_kept(number)) corners.push_back(place(number));
  }
  return corners;
}

}  // namespace scree
