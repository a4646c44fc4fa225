// Names of the deck's parts, resolved to indices of the model while it is built.
#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "deck/deck.hpp"
#include "mesh/triangle_mesh.hpp"
#include "model/data/bodies.hpp"

namespace scree {

inline constexpr const char* kGroundName = "ground";

using NameMap = std::map<std::string, int>;

// A marker of the deck: on a body, on each body of a row, or on the ground.
struct NamedMarker {
  std::vector<int> bodies;  // only kGround for the ground
  bool row = false;
  Marker marker;
};

// Triangles of which a solid may be made; closed lines have end caps.
struct NamedMesh {
  TriangleMesh mesh;
  bool sheet = false;
  bool line = false;
  std::string crossing{};  // ModelMesh::crossing
};

struct ModelNames {
  NameMap materials, meshes, bodies, joints;
  // Bodies of a row in order; a single body is a row of one body.
  std::map<std::string, std::vector<int>> rows;
  std::map<std::string, NamedMarker> markers;
  std::vector<Real> densities;       // of the materials [kg/m^3], 0 where not given
  std::vector<NamedMesh> triangles;  // of the meshes
};

// Index of the name that `table.key` holds. what: "material", "body", ... for the message. Throws InputError
// with the known names.
int find_name(const NameMap& names, const DeckTable& table, const std::string& key, const std::string& what);
// find_name() for a name in a list.
int find_name(const NameMap& names, const std::string& name, const DeckTable& table, const std::string& key,
              const std::string& what);
// find_name() for a body; kGround for "ground".
int find_body(const ModelNames& names, const std::string& name, const DeckTable& table,
              const std::string& key);
// Bodies of the row `name`. known: names that are valid as well, for the message. Throws InputError.
const std::vector<int>& find_row(const ModelNames& names, const std::string& name, const DeckTable& table,
                                 const std::string& key, std::vector<std::string> known = {});
// The marker `name`. Throws InputError.
const NamedMarker& find_marker(const ModelNames& names, const std::string& name, const DeckTable& table,
                               const std::string& key);
// Material that `table.key` names; left out: the only material. Throws InputError.
int find_material(const ModelNames& names, const DeckTable& table, const std::string& key);
// Adds one entry of the list `table.key`, the name or number `shown`. Throws InputError where it is repeated.
template <class T>
void add_once(std::vector<T>& list, T value, const DeckTable& table, const std::string& key,
              const std::string& shown) {
  if (std::find(list.begin(), list.end(), value) != list.end())
    table.fail(key, shown + " is repeated; every entry must be another one");
  list.push_back(value);
}
// Adds a name. Throws InputError where it exists.
void add_name(NameMap& names, const std::string& name, int index, const DeckTable& table);

}  // namespace scree
