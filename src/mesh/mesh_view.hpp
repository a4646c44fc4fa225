// A mesh as contacts are found on it, in its own frame, in which it never changes. Host and device.
#pragma once

#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Triangles that lie in one plane and hang together. Contacts with a face are with the plane of its part.
struct MeshPart {
  Vec3 point, normal;  // unit, outwards [m]
  Index patch;         // parts joined over edges that turn by less than the feature angle
};

// flags of a triangle, << k for corner k or the edge from it to corner k + 1.
enum TriangleFlags : std::uint32_t {
  kInnerEdge = 1,     // between two triangles of one part
  kReversed = 8,      // the edge's lower vertex is corner k + 1
  kOwnsEdge = 64,     // and
  kOwnsVertex = 512,  // among its features, edges first, each by increasing k
};

struct MeshTriangle {
  Index vertex[3];
  Index part;
  std::uint32_t flags;
  Index first_feature, features;  // those that it owns: rows of MeshView::features
};

// MeshFeature::b of vertices; the latter has an edge that does not join two faces.
inline constexpr Index kVertex = -1, kOpenVertex = -2;

// An edge or a vertex that a sphere may touch, owned by the lowest of its triangles. `tests`: of an edge the
// parts of its faces (~part where the face runs from b to a), of a vertex the other ends of its edges.
struct MeshFeature {
  Index a, b;  // vertices, a < b; b below 0: a vertex
  Index first_test, tests;
  Index first_patch, patches;  // that it adjoins, increasing
  Vec3f outward;               // unit: the mean normal of its faces, at a vertex weighted by their angles
};

// A box of the tree, or of the whole mesh.
struct MeshBox {
  Vec3 min, max;  // [m]
};

// Boxes of a tree in which a node has up to kTreeWidth children: level 0 are groups of kTreeWidth triangles
// in their order, level l + 1 groups of kTreeWidth boxes of level l; the last level is one box.
inline constexpr Index kTreeWidth = 4;
inline constexpr int kMostLevels = 16;

struct MeshView {
  const Vec3* vertices;
  const MeshTriangle* triangles;
  const MeshPart* parts;
  const MeshFeature* features;
  const Index* tests;
  const Index* patches;          // of the features
  const Index* first_neighbour;  // of each patch, and the end: into neighbours
  const Index* neighbours;       // of a patch, increasing: those that it meets along an edge
  const MeshBox* boxes;
  Index triangle_count, part_count;
  Index level_start[kMostLevels + 1];  // into boxes
  int levels;
  bool sheet;      // two sides; else closed, with an outside
  Real cosine;     // of the feature angle
  Real round_off;  // a few units in the last place of the largest coordinate [m]
  Real flatness;   // how far the vertices of a part may be from its plane [m]
};

}  // namespace scree
