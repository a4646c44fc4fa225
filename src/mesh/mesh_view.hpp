// A mesh as the contact search uses it, constant in its own frame. Host and device.
#pragma once

#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"

namespace scree {

// Connected coplanar triangles. Contacts with a face are contacts with the plane of its part.
struct MeshPart {
  Vec3 point, normal;  // unit, outwards [m]
  Index patch;         // parts connected over edges whose angle is below the feature angle
};

// flags of a triangle, << k for corner k or the edge from it to corner k + 1.
enum TriangleFlags : std::uint32_t {
  kInnerEdge = 1,     // between two triangles of one part
  kReversed = 8,      // the edge's lower vertex is corner k + 1
  kOwnsEdge = 64,     // owns edge k
  kOwnsVertex = 512,  // owns vertex k; edges come first in its features, each by increasing k
};

struct MeshTriangle {
  Index vertex[3];
  Index part;
  std::uint32_t flags;
  Index first_feature, features;  // rows of MeshView::features that it owns
};

// Values of MeshFeature::b for vertices; kOpenVertex: with an edge that does not join two faces.
inline constexpr Index kVertex = -1, kOpenVertex = -2;

// An edge or a vertex that a sphere may touch, owned by the lowest of its triangles. `tests`: for an edge
// the parts of its faces (~part where the face runs from b to a), for a vertex the other ends of its edges.
struct MeshFeature {
  Index a, b;  // vertices, a < b; b below 0: a vertex
  Index first_test, tests;
  Index first_patch, patches;  // next to it, increasing
  Vec3f outward;               // unit: the mean normal of its faces, weighted by their angles at a vertex
};

// A box of the tree, or of the whole mesh.
struct MeshBox {
  Vec3 min, max;  // [m]
};

// Boxes of a tree whose nodes have up to kTreeWidth children: boxes of level 0 contain kTreeWidth
// consecutive triangles, boxes of level l + 1 contain kTreeWidth boxes of level l; the last level is one
// box.
inline constexpr Index kTreeWidth = 4;
inline constexpr int kMostLevels = 16;

struct MeshView {
  const Vec3* vertices;
  const MeshTriangle* triangles;
  const MeshPart* parts;
  const MeshFeature* features;
  const Index* tests;
  const Index* patches;          // of the features
  const Index* first_neighbour;  // per patch its first entry of `neighbours`, and the end
  const Index* neighbours;       // per patch, increasing: the patches with which it shares an edge
  const MeshBox* boxes;
  Index triangle_count, part_count;
  Index level_start[kMostLevels + 1];  // first box of each level
  int levels;
  bool sheet;      // open (two-sided) surface; otherwise closed, with an outside
  Real cosine;     // of the feature angle
  Real round_off;  // a few units in the last place of the largest coordinate [m]
  Real flatness;   // largest distance of a part's vertices from its plane [m]
};

// The triangles near a sphere that a search reads.
struct TriangleRow {
  static constexpr Index kBits = 64;

  const Index* triangles;
  Index count;
  Index likely = -1;  // a triangle that the centre may be over; -1: unknown. It affects the run time only
  // Bit i: whether the i-th triangle is read; those beyond the bits always are.
  std::uint64_t chosen = ~std::uint64_t{0};

  SCREE_HD bool is_chosen(Index i) const { return i >= kBits || (chosen >> i & 1) != 0; }
};

}  // namespace scree
