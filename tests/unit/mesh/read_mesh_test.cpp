// Meshes from files: the three formats, and messages for broken files.
#include "mesh/read_mesh.hpp"

#include <unistd.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.hpp"
#include "mesh/mesh_checks.hpp"
#include "mesh/mesh_mass.hpp"
#include "mesh/weld.hpp"
#include "support/catch.hpp"
#include "unit/mesh/mesh_files.hpp"

namespace scree {

namespace {

// The message of the refusal; "": it is read.
std::string refusal(const std::string& bytes, const std::string& name) {
  try {
    parse_mesh(bytes, name);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

void check_tetrahedron(const TriangleMesh& read) {
  const TriangleMesh mesh = welded(read);
  CHECK(mesh.vertices.size() == 4);
  CHECK(mesh.triangles.size() == 4);
  for (const std::string& trouble : mesh_defects(mesh, false)) FAIL_CHECK(trouble);
}

}  // namespace

TEST_CASE("one tetrahedron in every format") {
  for (const MeshFile& file : tetrahedron_files()) {
    CAPTURE(file.name);
    check_tetrahedron(parse_mesh(file.bytes, file.name));
  }
}

TEST_CASE("decimal numbers become the nearest double") {
  for (const MeshFile& file : tetrahedron_files()) {
    CAPTURE(file.name);
    const TriangleMesh mesh = parse_mesh(file.bytes, file.name);
    CHECK(mesh.vertices[mesh.triangles[0][0]].x == (file.single ? Real(0.1f) : 0.1));
  }
}

TEST_CASE("dialects") {
  const std::string stl = ascii_stl();
  std::string windows;
  for (const char c : obj()) windows += c == '\n' ? "\r\n" : std::string(1, c);
  check_tetrahedron(parse_mesh(windows, "windows.OBJ"));
  check_tetrahedron(parse_mesh("\xef\xbb\xbf" + stl, "marked.stl"));
  std::string capitals = stl;
  for (char& c : capitals) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  check_tetrahedron(parse_mesh(capitals, "capitals.stl"));
  // Two solids, without names; normals that are no numbers.
  CHECK(parse_mesh(
            "solid\nfacet normal nan nan nan outer loop vertex 0 0 0\nvertex +1 0 0\nvertex 0 1. 0\nendloop "
            "endfacet endsolid\nsolid\nendsolid\n",
            "a.stl")
            .triangles.size() == 1);
  // Negative indices, with texture and normal; comments, one like a Windows folder; a continued line.
  const TriangleMesh back = parse_mesh(
      "# C:\\meshes\\\nv 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nvn 0 0 1\nv 0 1 0\ng a\nf -3/1/1 \\\n -2//1 -1 # last",
      "a.obj");
  CHECK(back.triangles == std::vector<std::array<Index, 3>>{{0, 1, 2}});
  // Faces before vertices, other elements and properties between, lists among them.
  const TriangleMesh ply = parse_mesh(
      "ply\nformat ascii 1.0\nelement face 1\nproperty uchar red\nproperty list uint8 uint vertex_index\n"
      "element vertex 3\nproperty float nx\nproperty double z\nproperty list char float w\nproperty double "
      "y\n"
      "property double x\nelement edge 1\nproperty int v\nobj_info x\nend_header\n255 3 2 1 0\n"
      "nan 7 2 0.5 0.25 4 1\n1 8 0 5 2\n\n1 9 1 3 6 3\n42\n",
      "a.ply");
  CHECK(ply.vertices == std::vector<Vec3>{{1, 4, 7}, {2, 5, 8}, {3, 6, 9}});
  CHECK(ply.triangles == std::vector<std::array<Index, 3>>{{2, 1, 0}});
  // Whole numbers of every type.
  const auto types = [](auto x, const std::string& type) {
    const std::string bytes = "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty " + type +
                              " x\nproperty " + type + " y\nproperty " + type +
                              " z\nelement face 1\nproperty list char uchar vertex_index\nend_header\n";
    std::string body;
    for (int k = 0; k < 9; ++k) body += bytes_of(x, true);
    return parse_mesh(bytes + body + std::string("\3\0\1\2", 4), "a.ply").vertices[2].z;
  };
  CHECK(types(std::int8_t(-100), "char") == -100);
  CHECK(types(std::uint8_t(200), "uint8") == 200);
  CHECK(types(std::int16_t(-30000), "int16") == -30000);
  CHECK(types(std::uint16_t(60000), "ushort") == 60000);
  CHECK(types(std::int32_t(-2000000000), "int") == -2000000000);
  CHECK(types(std::uint32_t(4000000000u), "uint32") == 4000000000.);
  CHECK(types(-0.1f, "float32") == Real(-0.1f));
}

TEST_CASE("solids of polygons") {
  for (const MeshFile& file : polygon_files()) {
    CAPTURE(file.name);
    const TriangleMesh mesh = welded(parse_mesh(file.bytes, file.name));
    CHECK(mesh_defects(mesh, false) == std::vector<std::string>{});
    CHECK(mesh.triangles.size() == (file.name == "l.obj" ? 20 : 12));
    CHECK(mesh_volume(mesh) == (file.name == "l.obj" ? 3 : 1));
  }
}

TEST_CASE("polygons are cut into triangles of their winding") {
  const auto area_of = [](const std::string& text, std::size_t triangles) {
    const TriangleMesh mesh = parse_mesh(text, "a.obj");
    CHECK(mesh.triangles.size() == triangles);
    for (const auto& [a, b, c] : mesh.triangles)
      CHECK(cross(mesh.vertices[b] - mesh.vertices[a], mesh.vertices[c] - mesh.vertices[a]).z >= 0);
    return mesh_area(mesh);
  };
  CHECK(area_of("v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nf 1 2 3 4", 2) == 6);
  // An L, begun at every corner; a corner on a straight side.
  const std::string l = "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf";
  for (int first = 0; first < 6; ++first) {
    std::string face;
    for (int k = 0; k < 6; ++k) face += " " + std::to_string((first + k) % 6 + 1);
    CHECK(area_of(l + face, 4) == 3);
  }
  for (const char* const face : {" 1 2 3 4", " 2 3 4 1", " 3 4 1 2", " 4 1 2 3"})
    CHECK(area_of(std::string("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 2 0\nf") + face, 2) == 2);
  // A hole, connected to the outline by a double edge.
  CHECK(
      area_of("v 0 0 0\nv 3 0 0\nv 3 3 0\nv 0 3 0\nv 1 1 0\nv 1 2 0\nv 2 2 0\nv 2 1 0\nf 1 2 3 4 1 5 6 7 8 5",
              8) == 8);
  // A comb, seen along each axis and from behind.
  const auto comb = [](const char* form) {
    std::string text, face = "f";
    for (int k = 0; k < 20; ++k) {
      const std::string along = std::to_string(k < 10 ? k : 19 - k),
                        up = std::to_string(k < 10 ? 0 : 1 + 5 * (k % 2));
      for (const char* c = form; *c; ++c) text += *c == 'a' ? along : *c == 'u' ? up : std::string(1, *c);
      face += " " + std::to_string(k + 1);
    }
    return mesh_area(parse_mesh(text + face, "a.obj"));
  };
  const Real area = comb("v a u 0\n");
  CHECK(area > 9);
  for (const char* const form : {"v u a 0\n", "v a 0 u\n", "v u 0 a\n", "v 0 a u\n", "v 0 u a\n"})
    CHECK(comb(form) == area);
}

TEST_CASE("messages for files that cannot be read") {
  namespace fs = std::filesystem;
  const fs::path folder = fs::temp_directory_path() / ("scree_meshes_" + std::to_string(::getpid()));
  fs::create_directory(folder);
  const auto message = [&](const std::string& name) -> std::string {
    try {
      read_mesh((folder / name).string());
      return "";
    } catch (const IoError& error) {
      return error.what();
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string at = (folder / "").string();
  CHECK(message("none.stl") == at + "none.stl: cannot be read: No such file or directory");
  fs::create_directory(folder / "folder.stl");
  CHECK(message("folder.stl") == at + "folder.stl: is a folder; must be a file");
  fs::create_symlink("/dev/zero", folder / "endless.stl");
  CHECK(message("endless.stl") == at + "endless.stl: is not a regular file");
  std::ofstream(folder / "empty.ply");
  CHECK(message("empty.ply") == at + "empty.ply: is empty");
  std::ofstream(folder / "step.stp") << "x";
  CHECK(message("step.stp") == at + "step.stp: must end with .stl, .obj or .ply");
  std::ofstream(folder / "a.obj") << obj();
  CHECK(message("a.obj") == "");
  fs::resize_file(folder / "empty.ply", std::uintmax_t(1) << 31);  // sparse: no block of it is written
  CHECK(message("empty.ply") == at + "empty.ply: 2147483648 bytes; must be less than 2147483648");
  fs::remove_all(folder);
}

TEST_CASE("messages for broken STL") {
  const std::string text = ascii_stl(), binary = binary_stl();
  CHECK(refusal("solid a\nendsolid a\n", "a.stl") == "a.stl: has no triangles");
  CHECK(refusal(binary_stl().replace(80, 4, bytes_of(std::uint32_t(0))).substr(0, 84), "a.stl") ==
        "a.stl: has no triangles");
  CHECK(refusal(text.substr(0, text.rfind("endsolid")), "a.stl") ==
        "a.stl:30: ends before facet or endsolid: the file is cut");
  CHECK(refusal(text.substr(0, text.find("endloop")), "a.stl") ==
        "a.stl:7: ends before endloop: the file is cut");
  CHECK(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 nan 0\n", "a.stl") ==
        "a.stl:4: coordinate \"nan\": must be a finite number");
  CHECK(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 1e999 0\n", "a.stl") ==
        "a.stl:4: coordinate \"1e999\": must be a finite number");
  CHECK(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0,5 0\n", "a.stl") ==
        "a.stl:4: coordinate \"0,5\": must be a number");
  CHECK(refusal("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 1\n", "a.stl") ==
        "a.stl:4: ends before a coordinate");
  CHECK(refusal("solid a\nface normal", "a.stl") == "a.stl:2: \"face\": must be facet or endsolid");
  CHECK(refusal("sold a", "a.stl") ==
        "a.stl: is neither text that begins with \"solid\" nor as long as the 84 bytes that binary STL "
        "begins with");
  CHECK(refusal(binary.substr(0, 200), "a.stl") ==
        "a.stl: 200 bytes; must be 284, as binary STL with 4 triangles: the file is cut");
  CHECK(refusal(binary + "more", "a.stl") == "a.stl: 288 bytes; must be 284, as binary STL with 4 triangles");
  for (const std::uint32_t count : {0x7fffffffu, 0x80000000u, 0xffffffffu}) {
    std::string large = binary;
    large.replace(80, 4, bytes_of(count));
    CHECK(refusal(large, "a.stl")
              .ends_with("as binary STL with " + std::to_string(count) + " triangles: the file is cut"));
  }
  std::string infinite = binary;
  infinite.replace(84 + 50 + 12 + 8, 4, bytes_of(std::numeric_limits<float>::infinity()));
  CHECK(refusal(infinite, "a.stl") == "a.stl: triangle 1 (from 0): coordinates must be finite numbers");
}

TEST_CASE("messages for broken OBJ") {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  const auto message = [&](const std::string& rest) { return refusal(corners + rest, "a.obj"); };
  CHECK(message("") == "a.obj: has no triangles");
  CHECK(message("f 1 2 5") == "a.obj:5: vertex number 5: must be 1 to 4, those above this line, or -1 to -4");
  CHECK(message("f 1 2 0").starts_with("a.obj:5: vertex number 0: must be"));
  CHECK(message("f 1 2 -5").starts_with("a.obj:5: vertex number -5: must be"));
  CHECK(message("f 1 2 4294967299").starts_with("a.obj:5: vertex number 4294967299: must be"));
  CHECK(message("f 1 2 99999999999999999999") ==
        "a.obj:5: vertex number \"99999999999999999999\": is too large");
  CHECK(message("f 1 2 x") == "a.obj:5: vertex number \"x\": must be a whole number");
  CHECK(message("f 1 /2 3") == "a.obj:5: ends before a vertex number");
  CHECK(message("f 1 2") == "a.obj:5: 2 corners; a face must have at least 3");
  CHECK(message("f 1 4 2 3") ==
        "a.obj:5: a face cannot be cut into triangles: it crosses itself or has no area");
  CHECK(message("v 3 3 0\nv 2 0.2 0\nf 1 5 3 6 4").ends_with("it crosses itself or has no area"));
  CHECK(message("l 1 2") == "a.obj:5: \"l\": points and lines are no surface; leave them out");
  CHECK(message("curv 1 2") == "a.obj:5: \"curv\": no statement of a polygon mesh");
  CHECK(message("v 1 inf 0") == "a.obj:5: coordinate \"inf\": must be a finite number");
  CHECK(message("v 1 0") == "a.obj:5: ends before a coordinate");
  CHECK(message(std::string(100, 'x')) ==
        "a.obj:5: \"" + std::string(40, 'x') + "...\": no statement of a polygon mesh");
  std::string many = "f", places;
  for (int k = 0; k < 1001; ++k) {
    places += "v " + std::to_string(k % 2) + " " + std::to_string(k) + " 0\n";
    many += " " + std::to_string(k + 5);
  }
  CHECK(message(places + many) ==
        "a.obj:1006: a face cannot be cut into triangles: 1001 corners and not convex; must be "
        "at most 1000 then");
}

TEST_CASE("messages for broken PLY") {
  const std::string text = ascii_ply(), binary = binary_ply<float>("float", false);
  const auto changed = [](std::string bytes, const std::string& from, const std::string& to) {
    return refusal(bytes.replace(bytes.find(from), from.size(), to), "a.ply");
  };
  CHECK(refusal("ply", "a.ply") == "a.ply:1: the second line must give the format");
  CHECK(refusal("plx\n", "a.ply") == "a.ply:1: must begin with ply");
  CHECK(changed(text, "ascii", "text") ==
        "a.ply:2: format \"text\": must be ascii, binary_little_endian or binary_big_endian");
  CHECK(changed(text, "1.0", "2.0") == "a.ply:2: format version \"2.0\": must be 1.0");
  CHECK(refusal(text.substr(0, text.find("property double z")), "a.ply") ==
        "a.ply:7: ends before end_header: the file is cut");
  CHECK(changed(text, "double y", "double w") == "a.ply:10: element vertex must have a property y");
  CHECK(changed(text, "double y", "real y").starts_with("a.ply:6: type \"real\": must be char, uchar"));
  CHECK(changed(text, "double y", "double x") == "a.ply:6: property \"x\" is repeated");
  CHECK(changed(text, "vertex_indices", "corners") ==
        "a.ply:14: element face must have one list of whole numbers vertex_indices or vertex_index");
  CHECK(changed(text, "list uchar", "list float") == "a.ply:9: the length of a list must be of a whole type");
  CHECK(changed(text, "element face", "element vertex") == "a.ply:8: element \"vertex\" is repeated");
  CHECK(changed(text, "element face 4", "element tristrips 4") ==
        "a.ply:14: strips of triangles are not read; must be faces");
  CHECK(changed(text, "comment", "element") == "a.ply:3: element count \"cut\": must be a whole number");
  for (const char* const count : {"2147483647", "2147483648", "4294967295", "9223372036854775807"}) {
    CHECK(changed(text, "vertex 4", std::string("vertex ") + count)
              .find(std::string(": ") + count +
                    " rows of element "
                    "\"vertex\": the rest of the file has room for 10 at most: it is cut, or the count is "
                    "wrong") != std::string::npos);
    CHECK(
        changed(binary, "face 4", std::string("face ") + count)
            .ends_with(
                std::string(count) +
                " rows of element "
                "\"face\": the rest of the file has room for 52 at most: it is cut, or the count is wrong"));
  }
  CHECK(changed(text, "face 4", "face -1") == "a.ply:8: element count -1: must be at least 0");
  CHECK(changed(text, "vertex 4", "vertex 5") == "a.ply:15: \"1\": more values than the header lists");
  CHECK(changed(text, "face 4", "face 3") == "a.ply:18: \"3\": more rows than the header counts");
  CHECK(changed(text, "vertex 4", "vertex 0") == "a.ply:11: value \"0.1\": must be a whole number");
  CHECK(changed(text, "3 0 2 1", "2 0 2") == "a.ply:15: 2 corners; a face must have at least 3");
  CHECK(changed(text, "3 0 2 1", "3 0 2 4") == "a.ply: face 0 (from 0): vertex 4: must be 0 to 3");
  CHECK(changed(text, "3 0 2 1", "3 0 2 -1") == "a.ply: face 0 (from 0): vertex -1: must be 0 to 3");
  CHECK(changed(text, "1 0 0", "1 nan 0") == "a.ply:11: value \"nan\": must be a finite number");
  CHECK(refusal(binary.substr(0, binary.size() - 1), "a.ply") ==
        "a.ply: byte 286: the file is cut: the header promises more");
  CHECK(refusal(binary + "x", "a.ply") == "a.ply: byte 290: 1 bytes more than the header counts");
}

}  // namespace scree
