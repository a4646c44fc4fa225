// Particles from CSV and HDF5 files.
#include "model/builder/particle_file.hpp"

#include <hdf5.h>

#include <filesystem>
#include <fstream>

#include "support/catch.hpp"
#include "support/models.hpp"
#include "support/particle_columns.hpp"

namespace scree {

namespace {

// A temporary folder.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / "scree_particle_file_test") {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return file(name);
  }

 private:
  std::filesystem::path path_;
};

void write_hdf5(const std::string& path, const std::map<std::string, std::vector<Real>>& columns) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  for (const auto& [name, values] : columns) {
    const hsize_t size = values.size();
    const hid_t space = H5Screate_simple(1, &size, nullptr);
    const hid_t set =
        H5Dcreate2(file, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set);
    H5Sclose(space);
  }
  H5Fclose(file);
}

}  // namespace

TEST_CASE("cells of CSV may be quoted, with commas and quotes in them") {
  const Folder folder;
  const std::string path = folder.write("q.csv", "\"x\", \"y\" ,\"radius\"\r\n\"+0.1\",\"-2e-1\",0.05\r\n");
  const ParticleColumns columns = read_particle_file(path, 2);
  CHECK(columns.at("y") == std::vector<Real>{-0.2});
  CHECK(columns.at("radius") == std::vector<Real>{0.05});
  CHECK_THROWS_WITH(read_particle_file(folder.write("c.csv", "x,\"a,\"\"b\"\"\"\n"), 2),
                    Catch::Contains("unknown column \"a,\"b\"\""));
}

TEST_CASE("tables in other formats are refused with their format and that of CSV") {
  const Folder folder;
  const auto trouble = [&](const std::string& name, const std::string& text) {
    try {
      read_particle_file(folder.write(name, text), 3);
    } catch (const std::runtime_error& error) {
      return std::string(error.what()).substr(folder.file(name).size());
    }
    return std::string();
  };
  const std::string wanted =
      "columns must be separated by commas, after a header line that names them, as x,y,z,radius; ";
  CHECK(trouble("a.csv", "x;y;z\n0.1;0.1;0.8\n") == ":1: " + wanted + "here semicolons stand between them");
  CHECK(trouble("b.txt", "# x y z r\n0.1 0.1 0.8 0.05\n") ==
        ":2: " + wanted + "here blanks stand between them");
  CHECK(trouble("c.tsv", "x\ty\tz\n1\t2\t3\n") == ":1: " + wanted + "here tabs stand between them");
  CHECK(trouble("d.csv", "# x,y,z\n1,2,3\n") ==
        ":2: the first line that is no comment must name the columns, as x,y,z,radius; it has numbers");
  CHECK(trouble("e.csv", "x,y,z\n1 2 3\n") ==
        ":2: 1 value; must be 3, as the header, and blanks are no commas");
  CHECK(trouble("f.csv", "x,y,z\n1,2 000,3\n") == ":2: column y = 2 000: must be a number");
  CHECK(trouble("g.xlsx", "PK\x03\x04 and more").starts_with(": is a ZIP archive, e.g. a spreadsheet"));
  CHECK(trouble("h.vtk", "# vtk DataFile Version 3.0\nx\nASCII\n")
            .starts_with(": is a legacy VTK file; must be CSV"));
  CHECK(trouble("i.csv", "x,y,z\r1,2,3\r") ==
        ": its lines end in a carriage return alone; they must end in a line feed");
}

TEST_CASE("HDF5 is recognised by its contents, and the program's own files are refused with a remedy") {
  const Folder folder;
  write_hdf5(folder.file("rows.dat"), {{"x", {1, 2}}, {"y", {3, 4}}});
  CHECK(read_particle_file(folder.file("rows.dat"), 2).at("y") == std::vector<Real>{3, 4});
  const hid_t file =
      H5Fcreate(folder.file("particles.vtkhdf").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Gclose(H5Gcreate2(file, "VTKHDF", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  H5Fclose(file);
  CHECK_THROWS_WITH(read_particle_file(folder.file("particles.vtkhdf"), 3),
                    Catch::Contains("is a snapshot file (VTKHDF): scree.packing.settled in Python makes"));
}

TEST_CASE("particles from CSV") {
  const Folder folder;
  const std::string path =
      folder.write("p.csv", "# a comment\nx, y, radius, vx, vy\n0.1,0.2,0.05,1,2\n\n-0.3,0.4,0.06,3,-4e-1\n");
  const ParticleColumns columns = read_particle_file(path, 2);
  CHECK(columns.at("x") == std::vector<Real>{0.1, -0.3});
  CHECK(columns.at("vy") == std::vector<Real>{2, -0.4});
  const std::string deck = kSmallDeck +
                           "[[contact.pairs]]\nstiffness = 1e4\n[[particles]]\nkind = \"file\"\nmass = 1.0\n"
                           "velocity = [10.0, 0.0]\nfile = \"" +
                           path + "\"\n";
  const ParticleSet p = model_of(deck).particles;
  CHECK(p.radius == std::vector<Real>{0.05, 0.06});
  CHECK(p.velocity[1] == Vec3{13, -0.4, 0});
  CHECK(contains(model_error(deck, {"particles.0.radius=0.1"}), "not used: the file has a column radius"));
}

TEST_CASE("moments of inertia from a file, and of groups beside it") {
  const Folder folder;
  const std::string path = folder.write("p.csv", "x,y,inertia_factor\n0.1,0.2,0.7\n-0.3,0.4,1\n");
  const std::string deck =
      kSmallDeck +
      "[[contact.pairs]]\nstiffness = 1e4\nfriction = 0.5\n"
      "[[particles]]\nkind = \"list\"\npositions = [[0.6, 0.6]]\nmass = 1.0\nradius = 0.05\n"
      "[[particles]]\nkind = \"file\"\nmass = 1.0\nradius = 0.05\nfile = \"" +
      path +
      "\"\n[[particles]]\nkind = \"list\"\npositions = [[0.8, 0.8]]\nmass = 1.0\n"
      "radius = 0.05\n";
  CHECK(model_of(deck).particles.inertia_factor == std::vector<Real>{0.5, 0.7, 1, 0.5});
  CHECK(model_of(deck).particles.totals.materials[0].smallest_inertia_factor == 0.5);
  CHECK(model_of(deck, {"particles.2.inertia_factor=0.25"}).particles.inertia_factor ==
        std::vector<Real>{0.5, 0.7, 1, 0.25});
  CHECK(contains(model_error(deck, {"particles.1.inertia_factor=0.5"}),
                 "not used: the file has a column inertia_factor"));
  for (const char* bad : {"0.0", "1.01", "-0.4"})
    CHECK(contains(model_error(deck, {std::string("particles.0.inertia_factor=") + bad}),
                   "must be a number above 0 and at most 1"));
  CHECK(contains(
      model_error(kSmallDeck + "[[contact.pairs]]\nstiffness = 1e4\n[[particles]]\nkind = \"list\"\n"
                               "positions = [[0.6, 0.6]]\nmass = 1.0\nradius = 0.05\ninertia_factor = 0.5\n"),
      "inertia_factor = 0.5: no particle rotates: no pair in contact.pairs has friction"));
  CHECK(contains(
      input_error([&] { read_particle_file(folder.write("q.csv", "x,y,inertia_factor\n0.1,0.2,1.1\n"), 2); }),
      "q.csv:2: column inertia_factor = 1.1: must be at most 1, all mass at the radius"));
}

TEST_CASE("spins from a file, and of groups beside it") {
  const Folder folder;
  const std::string path = folder.write("p.csv", "x,y,wz\n0.1,0.2,3\n-0.3,0.4,-4\n");
  const std::string list = "[[particles]]\nkind = \"list\"\nmass = 1.0\nradius = 0.05\npositions = ";
  const std::string deck = kSmallDeck + "[[contact.pairs]]\nstiffness = 1e4\nfriction = 0.5\n" + list +
                           "[[0.6, 0.6]]\n" +
                           "[[particles]]\nkind = \"file\"\nmass = 1.0\nradius = 0.05\nfile = \"" + path +
                           "\"\n" + list + "[[0.8, 0.8]]\n";
  CHECK(model_of(deck).particles.angular_velocity == std::vector<Vec3>{{}, {0, 0, 3}, {0, 0, -4}, {}});
  CHECK(model_of(deck, {"particles.1.angular_velocity=[1.0]"}).particles.angular_velocity ==
        std::vector<Vec3>{{}, {0, 0, 4}, {0, 0, -3}, {}});
  const std::string h5 = folder.file("p.h5");
  write_hdf5(h5, {{"x", {0.1}}, {"y", {0.2}}, {"z", {0.3}}, {"wx", {1}}, {"wy", {2}}, {"wz", {3}}});
  CHECK(read_particle_file(h5, 3).at("wy") == std::vector<Real>{2});
  CHECK(contains(
      input_error([&] { read_particle_file(folder.write("q.csv", "x,y,z,wz\n0.1,0.2,0.3,1\n"), 3); }),
      "column wx is missing"));
}

TEST_CASE("particles from HDF5") {
  const Folder folder;
  const std::string path = folder.file("p.h5");
  write_hdf5(path, {{"x", {0.1, 0.5}}, {"y", {0.2, 0.6}}, {"z", {0.3, 0.7}}, {"mass", {1, 2}}});
  const ParticleColumns columns = read_particle_file(path, 3);
  CHECK(columns.at("z") == std::vector<Real>{0.3, 0.7});
  CHECK(columns.at("mass") == std::vector<Real>{1, 2});
  CHECK_FALSE(columns.contains("radius"));
  write_hdf5(path, {{"x", {0.1, 0.5}}, {"y", {0.2}}});
  CHECK(
      contains(input_error([&] { read_particle_file(path, 2); }), "column y has 1 values; must be 2, as x"));
  CHECK_THROWS_AS(read_particle_file(folder.write("text.h5", "no HDF5"), 2), IoError);
}

TEST_CASE("a byte order mark and ends of lines of other systems") {
  const Folder folder;
  const ParticleColumns columns =
      read_particle_file(folder.write("p.csv", "\xef\xbb\xbfx,y\r\n0.1,0.2\r\n"), 2);
  CHECK(columns.at("x") == std::vector<Real>{0.1});
  CHECK(columns.at("y") == std::vector<Real>{0.2});
}

TEST_CASE("paths that are not files") {
  const Folder folder;
  const auto error = [&](const std::string& path) {
    return model_error(kSmallDeck + "[[particles]]\nkind = \"file\"\nmass = 1.0\nfile = \"" + path + "\"\n");
  };
  CHECK(contains(error(folder.file("")), "is a folder"));
  CHECK(contains(error(folder.file("absent.csv")), "absent.csv cannot be read: No such file or directory"));
  CHECK(contains(error("/dev/zero"), "/dev/zero is not a regular file"));
}

TEST_CASE("wrong values in HDF5 files name dataset and row") {
  const Folder folder;
  const std::string path = folder.file("p.h5");
  write_hdf5(path, {{"x", {0.1, 0.5}}, {"y", {0.2, 0.5}}, {"mass", {1, -1}}});
  CHECK(contains(input_error([&] { read_particle_file(path, 2); }),
                 "p.h5: dataset mass, row 1 = -1: must be a positive, finite number"));
}

TEST_CASE("a file without rows is a warning") {
  const Folder folder;
  const std::string csv = folder.write("p.csv", "x,y\n# none yet\n"), hdf5 = folder.file("p.h5");
  write_hdf5(hdf5, {{"x", {}}, {"y", {}}});
  for (const std::string& path : {csv, hdf5}) {
    const std::string deck = kSmallDeck +
                             "[[contact.pairs]]\nstiffness = 1e4\n[[particles]]\nkind = \"file\"\nmass = "
                             "1.0\nradius = 0.1\nfile = \"" +
                             path + "\"\n";
    CHECK(model_of(deck).particles.totals.count == 0);
    CHECK(model_warnings(deck) ==
          std::vector<std::string>{"particles.0.file = \"" + path +
                                   "\": the file has no rows; the group has no particles"});
  }
}

TEST_CASE("wrong files name file, line, column and value") {
  const Folder folder;
  const auto error = [&](const std::string& text, int dimension = 2) {
    const std::string path = folder.write("bad.csv", text);
    return input_error([&] { read_particle_file(path, dimension); });
  };
  CHECK(contains(error("x,y\n1,2\n3,abc\n"), "bad.csv:3: column y = abc: must be a number"));
  CHECK(contains(error("x,y,radus\n"), "bad.csv:1: unknown column \"radus\"; did you mean \"radius\"?"));
  CHECK(contains(error("x,y,x\n"), "column \"x\" is repeated"));
  CHECK(contains(error("x,y\n1,2,3\n"), "bad.csv:2: 3 values; must be 2, as the header"));
  CHECK(contains(error("x\n1\n"), "column y is missing"));
  CHECK(contains(error("x,y,vx\n1,2,3\n"), "column vy is missing"));
  CHECK(contains(error("x,y\n1,2\n", 3), "column z is missing"));
  CHECK(contains(error("x,y,radius\n\n1,2,-1\n"),
                 "bad.csv:3: column radius = -1: must be a positive, finite number"));
  CHECK(contains(error("x,y\n1,nan\n"), "y = nan: must be a finite number"));
  CHECK(contains(error(""), "column x is missing"));
}

}  // namespace scree
