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
        "Triangle surfaces that walls and bodies refer to (in 2D: lines). Particles and the shapes of bodies "
        "touch them. Meshes of bodies also touch planes, with the vertices of their convex hulls, where the "
        "deck has a contact law for the two materials. Meshes do not touch each other.",
        {name_key().required().about("Name for references and messages."),
         choice<MeshKind>("kind").required().about(
             "File: STL, OBJ or PLY. Rectangle: an open surface in the plane z = 0. Funnel, hopper: an open "
             "surface without top and bottom, round or with four flat sides, from the outlet at z = 0 to the "
             "top. Line: in 2D, through points; closed, the outline of a solid, otherwise an open line. All "
             "other kinds are closed solids about their z axis: plate, a box with a round hole along z; "
             "pipe, a tube; drum, a pipe with bars along its inside; screw, a core with a helical flight."),
         file("file").only_for(files).required().about("File, relative to the deck's folder."),
         real("scale", "")
             .only_for(files)
             .above(0)
             .otherwise("1.0")
             .about("Metres per unit of length of the file: 0.001 for a file in mm."),
         reals("stretch", "")
             .only_for(files)
             .entries(3)
             .left_out("none")
             .about("Factors along the file's x, y and z in addition to scale; one below 0 mirrors: [1, -1, "
                    "1] makes a left part from a right one."),
         real("weld", "m")
             .only_for(files)
             .above(0)
             .left_out("only vertices at equal positions are merged")
             .about("Vertices at most this far apart are merged."),
         reals("size", "m")
             .only_for(boxes)
             .above(0)
             .required()
             .about("Edge lengths along x, y and z; of a rectangle along x and y, of a hopper those of its "
                    "outlet."),
         reals("top_size", "m")
             .only_for(hoppers)
             .above(0)
             .entries(2)
             .required()
             .about("Edge lengths along x and y at z = length."),
         real("radius", "m")
             .only_for(round)
             .above(0)
             .required()
             .about("Radius: of a cone at z = 0, of a funnel at its outlet, of a pipe outside, of a drum "
                    "inside, of a screw that of its flight."),
         real("top_radius", "m")
             .only_for(cones)
             .at_least(0)
             .required_for({K::funnel})
             .otherwise("0.0")
             .about("Radius at z = length; 0 for a cone with a tip."),
         real("inner_radius", "m").only_for(pipes).above(0).required().about("Inside."),
         real("hole_radius", "m").only_for(plates).above(0).required().about("Radius of the hole."),
         real("length", "m")
             .only_for(long_ones)
             .above(0)
             .required()
             .about("Length along z, centred at z = 0; of a cone, funnel or hopper from z = 0; of a capsule "
                    "without its hemispheres."),
         real("outlet_length", "m")
             .only_for(outlets)
             .at_least(0)
             .otherwise("0.0")
             .about("Length of the straight tube below the outlet; 0: none."),
         integer("segments")
             .only_for(curved)
             .within(3, 10000)
             .left_out("from the size of the smallest particle")
             .about(
                 "Number of edges around the circumference; for plates and capsules a multiple of 4, for "
                 "screws at least 8. Left out: the smallest multiple of 4, from 16 to 360, for which the "
                 "facets deviate from the true circle by at most 5 % of the smallest particle's radius and "
                 "neighbouring facets form an angle below feature_angle, with edges of at least 0.4 of that "
                 "particle's diameter. The largest circle of the shape counts. 48 without particles."),
         integer("levels")
             .only_for(spheres)
             .within(0, 9)
             .left_out("from the size of the smallest particle")
             .about("How many times the 20 triangles of an icosahedron are split into four. Left out: the "
                    "smallest number from 2 to 6 for which the facets deviate from the sphere by at most 5 % "
                    "of the smallest particle's radius; 3 without particles."),
         real("wall", "m").only_for(drums).above(0).required().about("Thickness of the drum's wall."),
         real("end_wall", "m")
             .only_for(drums)
             .at_least(0)
             .otherwise("0.0")
             .about("Thickness of the discs that close the drum beyond its length; 0: open ends."),
         integer("lifters").only_for(drums).within(0, 1000).otherwise("0").about(
             "Number of bars along its inside."),
         real("lifter_height", "m")
             .only_for(drums)
             .above(0)
             .left_out("no lifters")
             .about("Height of the bars towards the axis."),
         real("lifter_width", "m")
             .only_for(drums)
             .above(0)
             .left_out("no lifters")
             .about("Width of the bars along the circumference."),
         real("core_radius", "m").only_for(screws).above(0).required().about("Radius of the core."),
         real("pitch", "m")
             .only_for(screws)
             .required()
             .about("Height of one turn of the flight; below 0: left-handed."),
         real("thickness", "m")
             .only_for(screws)
             .above(0)
             .required()
             .about("Thickness of the flight along z."),
         real("core_length", "m")
             .only_for(screws)
             .above(0)
             .left_out("length")
             .about("Length of the core, at least that of the flight."),
         vectors("points", "m")
             .only_for(lines)
             .required()
             .about("Points in the x-y plane that the line connects. A line that is not closed has two "
                    "sides, as an open surface. Lines rotate about z only, by quaternion."),
         boolean("closed").only_for(lines).otherwise("false").about(
             "Whether the last point is connected to the first, counterclockwise around the solid."),
         boolean("sheet").only_for(files).otherwise("false").about(
             "Whether the surface is open (two-sided), as a container that holds particles: it may have free "
             "edges. false: it encloses a solid."),
         real("coarsen", "m")
             .only_for(files)
             .above(0)
             .left_out("triangles as they are")
             .about("Coarsening: triangles are merged as long as no vertex of the file is farther than this "
                    "from the remaining surface. Sharp edges (feature_angle) and free edges are kept, and no "
                    "edge becomes sharp. Done before refine."),
         real("refine", "m")
             .above(0)
             .left_out("triangles as they are")
             .about("Edges longer than this are split."),
         real("feature_angle", "rad")
             .above(0)
             .within(0, 1.5)
             .otherwise("0.5235987755982988")
             .about("Edges at which the surface turns by less than this belong to a smooth surface, on which "
                    "contacts with nearly the same direction count once."),
         vector("offset", "m")
             .otherwise("zero")
             .about("Position of the mesh's origin in the frame of the body, or in the global frame.")},
        "kind"};
    for (const Key& key : orientation_keys("", "its own frame", "the body's frame or the global frame"))
      mesh.keys.push_back(key);
    return mesh;
  }();
  return keys;
}

}  // namespace scree
