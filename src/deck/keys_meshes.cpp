// Keys of meshes.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

const TableKeys& mesh_keys() {
  using K = MeshKind;
  static constexpr auto files = {K::file}, boxes = {K::box, K::plate, K::hopper, K::rectangle},
                        lines = {K::line}, spheres = {K::sphere}, plates = {K::plate},
                        cones = {K::cone, K::funnel}, pipes = {K::pipe}, drums = {K::drum},
                        screws = {K::screw}, hoppers = {K::hopper}, outlets = {K::funnel, K::hopper};
  static constexpr auto round = {K::cylinder, K::cone, K::sphere, K::capsule,
                                 K::pipe,     K::drum, K::screw,  K::funnel},
                        long_ones = {K::cylinder, K::cone,  K::capsule, K::pipe,
                                     K::drum,     K::screw, K::funnel,  K::hopper},
                        curved = {K::cylinder, K::cone, K::capsule, K::plate,
                                  K::pipe,     K::drum, K::screw,   K::funnel};
  static const TableKeys keys = [] {
    TableKeys mesh{
        "Surfaces of triangles that walls and bodies refer to. Particles and the shapes of bodies touch "
        "them; meshes of bodies touch planes, too, with the corners of their convex hulls, where the deck "
        "has a "
        "law for the two materials. Meshes do not touch each other. In 2D: lines.",
        {name_key().required().about("Name for references and messages."),
         choice<MeshKind>("kind").required().about(
             "File: STL, OBJ or PLY. Rectangle: a sheet in the plane z = 0. Funnel, hopper: a sheet open at "
             "both ends, round or with four flat sides, from the outlet at z = 0 up to the top. Line: in 2D, "
             "through points; closed, the outline of a solid, else a sheet. All others are closed solids "
             "about their axis z: plate, a box with a "
             "round hole along z; pipe, a tube; drum, a pipe with bars along its inside; screw, a core with "
             "a helical flight."),
         file("file").only_for(files).required().about("File, relative to the deck's folder."),
         real("scale", "")
             .only_for(files)
             .above(0)
             .otherwise("1.0")
             .about("Metres in the file's unit of length: 0.001 for a file in mm."),
         reals("stretch", "")
             .only_for(files)
             .entries(3)
             .left_out("none")
             .about(
                 "Factors along the file's x, y and z beside scale; one below 0 mirrors: [1, -1, 1] makes a "
                 "left part of a right one."),
         real("weld", "m")
             .only_for(files)
             .above(0)
             .left_out("equal places alone")
             .about("Vertices at most this far apart become one."),
         reals("size", "m")
             .only_for(boxes)
             .above(0)
             .required()
             .about("Edges along x, y and z; of a rectangle along x and y, of a hopper those of its outlet."),
         reals("top_size", "m")
             .only_for(hoppers)
             .above(0)
             .entries(2)
             .required()
             .about("Edges along x and y at z = length."),
         real("radius", "m")
             .only_for(round)
             .above(0)
             .required()
             .about("Radius: of a cone at z = 0, of a funnel of its outlet, of a pipe outside, of a drum "
                    "inside, of a screw of its "
                    "flight."),
         real("top_radius", "m")
             .only_for(cones)
             .at_least(0)
             .required_for({K::funnel})
             .otherwise("0.0")
             .about("Radius at z = length; of a cone, 0: a tip."),
         real("inner_radius", "m").only_for(pipes).above(0).required().about("Inside."),
         real("hole_radius", "m").only_for(plates).above(0).required().about("Of the hole."),
         real("length", "m")
             .only_for(long_ones)
             .above(0)
             .required()
             .about("Along z, about z = 0; of a cone, funnel or hopper from z = 0; of a capsule without its "
                    "half spheres."),
         real("outlet_length", "m")
             .only_for(outlets)
             .at_least(0)
             .otherwise("0.0")
             .about("Of the straight tube below the outlet; 0: none."),
         integer("segments")
             .only_for(curved)
             .within(3, 10000)
             .left_out("follows from the smallest particle")
             .about(
                 "Edges once around; of plates and capsules a multiple of 4, of screws at least 8. Left out: "
                 "the least multiple of 4, from 16 to 360, with which facets lie within 5 % of the smallest "
                 "particle's radius of the true circle and turn by less than feature_angle: edges are 0.4 of "
                 "the particle's diameter or longer. The largest circle of the shape counts. 48 without "
                 "particles."),
         integer("levels")
             .only_for(spheres)
             .within(0, 9)
             .left_out("follows from the smallest particle")
             .about("The 20 triangles of an icosahedron are split into four so many times. Left out: from 2 "
                    "to 6, "
                    "the least with which facets lie within 5 % of the smallest particle's radius of the "
                    "sphere; "
                    "3 without particles."),
         real("wall", "m").only_for(drums).above(0).required().about("Thickness of the drum's wall."),
         real("end_wall", "m")
             .only_for(drums)
             .at_least(0)
             .otherwise("0.0")
             .about("Thickness of the discs that close it beyond its length; 0: open ends."),
         integer("lifters").only_for(drums).within(0, 1000).otherwise("0").about("Bars along its inside."),
         real("lifter_height", "m")
             .only_for(drums)
             .above(0)
             .left_out("no lifters")
             .about("Of the bars, towards the axis."),
         real("lifter_width", "m")
             .only_for(drums)
             .above(0)
             .left_out("no lifters")
             .about("Of the bars, around."),
         real("core_radius", "m").only_for(screws).above(0).required().about("Of the core."),
         real("pitch", "m")
             .only_for(screws)
             .required()
             .about("Height of one turn of the flight; below 0: left-handed."),
         real("thickness", "m").only_for(screws).above(0).required().about("Of the flight, along z."),
         real("core_length", "m")
             .only_for(screws)
             .above(0)
             .left_out("length")
             .about("Length of the core, at least that of the flight."),
         vectors("points", "m")
             .only_for(lines)
             .required()
             .about(
                 "Places in the x-y plane that the line goes through. Where it is not closed, it is a sheet "
                 "with two sides. Lines turn about z alone, by quaternion."),
         boolean("closed").only_for(lines).otherwise("false").about(
             "Whether the last point is joined to the first, counterclockwise around what is solid."),
         boolean("sheet").only_for(files).otherwise("false").about(
             "Whether the surface has two sides and may have free edges, as a container that holds grains; "
             "else "
             "it encloses a solid."),
         real("coarsen", "m")
             .only_for(files)
             .above(0)
             .left_out("triangles as they are")
             .about(
                 "Triangles are joined as long as no vertex of the file is farther than this beside what "
                 "is left; sharp edges (feature_angle) and free ones stay, and no edge becomes sharp. Before "
                 "refine."),
         real("refine", "m")
             .above(0)
             .left_out("triangles as they are")
             .about("Edges longer than this are cut."),
         real("feature_angle", "rad")
             .above(0)
             .within(0, 1.5)
             .otherwise("0.5235987755982988")
             .about("Edges that turn by less are taken for parts of a smooth surface, on which contacts in "
                    "about the "
                    "same direction count once."),
         vector("offset", "m")
             .otherwise("zero")
             .about("Where its own origin lies in the frame of the body, or in the global one.")},
        "kind"};
    for (const Key& key : orientation_keys("", "its own frame", "the frame of the body, or the global one,"))
      mesh.keys.push_back(key);
    return mesh;
  }();
  return keys;
}

}  // namespace scree
