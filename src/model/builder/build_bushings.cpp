// Bushings between spatial bodies.
#include <fmt/format.h>

#include <cmath>

#include "model/builder/build_parts.hpp"
#include "model/derived/connections.hpp"
#include "physics/spatial_rotation.hpp"

namespace scree {

namespace {

constexpr Real kSquare = 1e-9;  // cosine of axes that must be perpendicular
// Tolerance for the symmetry of a matrix and for negative energies, relative to the roots of its diagonal.
constexpr Real kRounding = 1e-9;

// Frame of the bushing at t = 0, rows x, y, z.
Mat3 start_frame(const DeckTable& table) {
  if (table.has("axis") != table.has("second_axis"))
    table.fail(table.has("axis") ? "axis" : "second_axis",
               "axis and second_axis belong together: one is missing");
  if (!table.has("axis")) return identity3();
  const auto direction = [&](const char* key) {
    const Vec3 along = table.vector(key);
    if (norm(along) == 0) table.fail(key, "must not be 0");
    return (1 / norm(along)) * along;
  };
  const Vec3 z = direction("axis"), x = direction("second_axis");
  if (std::abs(dot(x, z)) > kSquare)
    table.fail("second_axis", fmt::format("must be perpendicular to axis; the cosine between them is {:.3g}, "
                                          "allowed is {:g}",
                                          dot(x, z), kSquare));
  return {x, cross(z, x), z};
}

// Sets the ends from the deck's markers, or from its point and axes.
void place_ends(const DeckTable& table, const Model& model, const Connection& connection, Bushing& bushing) {
  check_without_markers(table, {"point", "local_points", "axis", "second_axis"});
  if (!connection.markers && table.has("point") == table.has("local_points"))
    table.fail("point", "exactly one of the keys point, local_points and markers must be given");
  const Mat3 frame = start_frame(table), frames[2] = {frame, frame};
  const Ends ends = find_ends(table, model, connection, frames);
  for (std::size_t side = 0; side < 2; ++side)
    bushing.point[side] = ends[side].point, bushing.marker[side] = ends[side].orientation;
}

// Throws InputError where a deflection has a negative energy. The matrix is scaled to a unit diagonal and so
// independent of units.
void check_no_gain(const DeckTable& table, const std::string& key, const Matrix6& a) {
  Matrix6 l{};  // Cholesky factor of the scaled matrix plus a small multiple of the unit matrix
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const Real scale = std::sqrt(a[i][i] * a[j][j]);
      Real rest = i == j ? 1 + kRounding : scale > 0 ? a[i][j] / scale : 0;
      for (std::size_t k = 0; k < j; ++k) rest -= l[i][k] * l[j][k];
      if (i == j && !(rest > 0))
        table.fail(key, fmt::format("is not positive semidefinite: of its first {0} rows and columns alone "
                                    "some deflection has an energy below 0",
                                    i + 1));
      l[i][j] = i == j ? std::sqrt(rest) : rest / l[j][j];
    }
}

Matrix6 read_matrix(const DeckTable& table, const std::string& key) {
  Matrix6 a{};
  if (!table.has(key)) return a;
  const std::vector<Real>& given = table.reals(key);
  if (given.size() != 6 && given.size() != 36)
    table.fail(key,
               fmt::format("must have 6 entries, its diagonal, or 36, row by row; it has {}", given.size()));
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < 6; ++j)
      a[i][j] = given.size() == 36 ? given[6 * i + j] : i == j ? given[i] : 0;
  for (std::size_t i = 0; i < 6; ++i)
    if (a[i][i] < 0) table.fail(key, fmt::format("its diagonal entry {} is {}, below 0", i + 1, a[i][i]));
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      if (std::abs(a[i][j] - a[j][i]) > kRounding * std::abs(a[i][j] + a[j][i]))
        table.fail(key,
                   fmt::format("is not symmetric: row {0}, column {1} is {2}, row {1}, column {0} is {3}",
                               i + 1, j + 1, a[i][j], a[j][i]));
      a[i][j] = a[j][i] = (a[i][j] + a[j][i]) / 2;
      if (a[i][j] != 0 && (a[i][i] == 0 || a[j][j] == 0))
        table.fail(key, fmt::format("is not positive semidefinite: row {}, column {} is {} beside a 0 on the "
                                    "diagonal",
                                    i + 1, j + 1, a[i][j]));
    }
  check_no_gain(table, key, a);
  return a;
}

// Checks the rotation at t = 0 between the frames, which only markers can give.
void check_start_rotation(const DeckTable& table, const Model& model, const Bushing& bushing) {
  Quaternion frame[2];
  for (int side = 0; side < 2; ++side)
    frame[side] = quaternion_of(transposed(global_frame(model, bushing.body[side], bushing.marker[side])));
  const Real turn = norm(rotation_vector(conjugate(frame[0]) * frame[1]));
  if (bushing.resists_rotation() && turn > kMaxBushingRotation)
    table.fail("markers", fmt::format("their frames are rotated by {:.6g} rad relative to each other at t = "
                                      "0; a bushing allows up to {:g} rad",
                                      turn, kMaxBushingRotation));
}

Bushing build_bushing(const DeckTable& table, const Model& model, const Connection& connection) {
  Bushing bushing;
  bushing.name = connection.name;
  for (int side = 0; side < 2; ++side) bushing.body[side] = connection.body[side];
  check_same_kind(table, model, connection);
  if (between(model, bushing.body) == BodyKind::planar)
    table.fail(table.has("bodies") ? "bodies" : "name",
               "bushings are between spatial bodies, or one and the ground; these are planar (bodies.kind)");
  place_ends(table, model, connection, bushing);
  bushing.stiffness = read_matrix(table, "stiffness");
  bushing.damping = read_matrix(table, "damping");
  if (table.has("preload"))
    for (std::size_t k = 0; k < 6; ++k) bushing.preload[k] = table.reals("preload")[k];
  check_start_rotation(table, model, bushing);
  return bushing;
}

}  // namespace

bool Bushing::resists_rotation() const {
  for (std::size_t a = 3; a < 6; ++a) {
    if (preload[a] != 0) return true;
    for (std::size_t b = 0; b < 6; ++b)
      if (stiffness[a][b] != 0 || damping[a][b] != 0) return true;
  }
  return false;
}

void build_bushings(const DeckTable& deck, Model& model, const ModelNames& names) {
  NameMap taken;
  for (const DeckTable& table : deck.tables("bushings"))
    for (const Connection& connection : find_connections(table, names)) {
      add_name(taken, connection.name, static_cast<int>(model.bushings.size()), table);
      model.bushings.push_back(build_bushing(table, model, connection));
    }
}

}  // namespace scree
