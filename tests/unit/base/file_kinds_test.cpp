// Recognition of files by their first bytes.
#include "base/file_kinds.hpp"

#include "support/catch.hpp"

namespace scree {

using namespace std::string_view_literals;

TEST_CASE("files are recognised by their first bytes, ambiguous text is not") {
  CHECK(kind_of_file("\x89HDF\r\n\x1a\n\0"sv) == "an HDF5 file");
  CHECK(is_hdf5("\x89HDF\r\n\x1a\n"sv));
  CHECK(kind_of_file("PK\x03\x04zip"sv).starts_with("a ZIP archive"));
  CHECK(kind_of_file("\xff\xfex\0,\0"sv).starts_with("text in UTF-16"));
  CHECK(kind_of_file("# vtk DataFile Version 3.0\n"sv) == "a legacy VTK file");
  CHECK(kind_of_file("<?xml version=\"1.0\"?>\n<!-- made -->\n<robot name=\"a\">"sv) ==
        "a robot model (URDF)");
  CHECK(kind_of_file("<?xml version=\"1.0\"?>\n<VTKFile>"sv) == "a VTK file (XML)");
  CHECK(kind_of_file(" \n{\"a\": 1}"sv) == "JSON");
  CHECK(kind_of_file("abc\0def"sv) == "a binary file");
  for (const auto text :
       {""sv, "x,y,z\n1,2,3\n"sv, "# x y z\n"sv, "\xef\xbb\xbfx,y\n"sv, "title = \"\xc3\xa9\"\n"sv})
    CHECK(kind_of_file(text).empty());
}

}  // namespace scree
