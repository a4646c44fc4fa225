#include "base/file_kinds.hpp"

#include <array>
#include <fstream>

#include "base/index.hpp"

namespace scree {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view kHdf5 = "\x89HDF\r\n\x1a\n"sv;

struct Kind {
  std::string_view beginning;
  const char* name;
};

constexpr auto kKinds = std::to_array<Kind>({
    {kHdf5, kHdf5Kind},
    {"PK\x03\x04"sv, "a ZIP archive, e.g. a spreadsheet (.xlsx, .ods)"},
    {"\xd0\xcf\x11\xe0"sv, "an old office file (.xls, .doc)"},
    {"\x1f\x8b"sv, "compressed with gzip"},
    {"BZh"sv, "compressed with bzip2"},
    {"\xfd\x37zXZ"sv, "compressed with xz"},
    {"\x28\xb5\x2f\xfd"sv, "compressed with zstd"},
    {"\x89PNG"sv, "a picture (PNG)"},
    {"\xff\xd8\xff"sv, "a picture (JPEG)"},
    {"%PDF"sv, "a PDF document"},
    {"\x7f"
     "ELF"sv,
     "a program or library"},
    {"\x93NUMPY"sv, "an array of NumPy (.npy)"},
    {"\xff\xfe"sv, "text in UTF-16; it must be in UTF-8"},
    {"\xfe\xff"sv, "text in UTF-16; it must be in UTF-8"},
    {"# vtk DataFile"sv, "a legacy VTK file"},
    {"ITEM: TIMESTEP"sv, "a LAMMPS or LIGGGHTS dump"},
    {"ply\n"sv, "a triangle mesh (PLY)"},
    {"ply\r"sv, "a triangle mesh (PLY)"},
    {"solid "sv, "a triangle mesh (STL)"},
});

// Kind of an XML file by its elements, as far as comments and declarations leave them within the beginning.
std::string kind_of_xml(std::string_view text) {
  if (text.find("<robot") != text.npos) return kUrdfKind;
  if (text.find("<mujoco") != text.npos) return "a MuJoCo model (XML)";
  if (text.find("<sdf") != text.npos) return "a Gazebo world (SDF)";
  if (text.find("<VTKFile") != text.npos) return "a VTK file (XML)";
  if (text.find("<Xdmf") != text.npos) return "an XDMF file";
  if (text.find("<html") != text.npos || text.find("<!DOCTYPE html") != text.npos) return "a web page";
  return "XML";
}

}  // namespace

bool is_hdf5(std::string_view beginning) { return beginning.starts_with(kHdf5); }

std::string kind_of_file(std::string_view beginning) {
  for (const Kind& kind : kKinds)
    if (beginning.starts_with(kind.beginning)) return kind.name;
  if (beginning.find('\0') != beginning.npos) return "a binary file";  // no text has one
  const std::size_t first = beginning.find_first_not_of(" \t\r\n\xef\xbb\xbf");
  if (first == beginning.npos) return "";
  if (beginning[first] == '<') return kind_of_xml(beginning);
  if (beginning[first] == '{') return "JSON";
  return "";
}

std::string beginning_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes(kFileBeginning, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(as_size(file.gcount()));
  return bytes;
}

}  // namespace scree
