// Keys of what a run writes.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

const TableKeys& output_keys() {
  static const TableKeys keys{
      "What is written, and how often.",
      {text("directory")
           .otherwise("\"\"")
           .about("Folder of the results, relative to the folder in which scree is started, not to the "
                  "deck's; empty: results/ and the deck's name. --output takes precedence. A run with "
                  "--restart continues history and snapshots in the folder of its checkpoint, and begins new "
                  "ones in any other folder."),
       real("snapshot_interval", "s")
           .at_least(0)
           .otherwise("0.0")
           .about("Simulated time between snapshots; 0: only the first and the last state."),
       texts("fields")
           .otherwise("[\"radius\", \"velocity\", \"force\", \"contacts\", \"material\", \"group\"]")
           .about("Fields that snapshots have of each particle besides its position and its global id; the "
                  "end of this manual lists all fields. material and group are indices into the names in "
                  "/Scree/materials and /Scree/groups of particles.vtkhdf."),
       texts("surface_fields")
           .otherwise("[\"pressure\", \"shear\"]")
           .about("Fields that snapshots have of each triangle of the meshes. pressure [Pa] and shear [Pa], "
                  "a vector: normal and tangential traction, the contact forces of particles on the triangle "
                  "at that time over its area. Sums over all steps since t = 0: impact_work [J], the "
                  "dissipation of normal forces, the formation of JKR contacts and liquid bridges included; "
                  "sliding_work [J], "
                  "the dissipation of friction; wear_depth [m], the wear volume of Archard's law "
                  "(wear_coefficient of the pairs) over the area. In 2D a segment of a line consists of two "
                  "triangles: both have the traction per length of the segment [N/m] of a line that is 1 m "
                  "deep; the dissipation is at one of the two."),
       boolean("contacts")
           .otherwise("false")
           .about("Whether snapshots have the contacts of particles and of bodies' discs and spheres "
                  "(contacts.vtkhdf), one line segment each, with forces, overlap and partners."),
       boolean("links").otherwise("true").about(
           "Whether snapshots have the joints, spring-dampers and bushings (links.vtkhdf), one line segment "
           "each, with force and torque."),
       real("history_interval", "s")
           .at_least(0)
           .otherwise("0.0")
           .about("Simulated time between history samples, which are at its multiples and also at the start "
                  "and the end of a run. 0: every step."),
       real("checkpoint_interval", "s")
           .at_least(0)
           .otherwise("0.0")
           .about("Simulated time between checkpoints; 0: none at such intervals."),
       real("checkpoint_wall_interval", "s")
           .at_least(0)
           .otherwise("600.0")
           .about("Wall-clock time since the last checkpoint after which another one is written; 0: none at "
                  "such intervals. On failure and on a signal a checkpoint is written in any case."),
       integer("compression")
           .within(0, 9)
           .otherwise("0")
           .about("Compression of snapshots and checkpoints: 0, none; 1 to 9, deflate from fast to small."),
       boolean("history_csv").otherwise("false").about("Whether the history is also written as CSV."),
       texts("history_bodies").otherwise("[]").about("Bodies, or rows of bodies, whose motion is recorded."),
       texts("history_contacts")
           .otherwise("[]")
           .about("Bodies, rows of bodies, meshes of bodies (\"bucket.teeth\"), walls, and sides of the "
                  "domain that are walls (\"x_min\"), on which the contact force, its torque and the number "
                  "of contacts are recorded. The torque is about a body's centre, a wall's point as it moves "
                  "(for a side space.min or space.max; for a mesh its origin), and for a row, whose bodies "
                  "are summed, about the origin."),
       integer("history_reactions")
           .at_least(0)
           .otherwise("100")
           .about("Number of joints, drivers and couplers whose reactions are recorded, the first ones in "
                  "the deck. Reactions are computed from positions, velocities and forces at that instant "
                  "and do not depend on earlier steps. The reaction of a coupler is that on the second body "
                  "of its first joint."),
       integer("history_efforts")
           .at_least(0)
           .otherwise("100")
           .about("Number of motors, springs, limits and frictions of joints whose coordinate, rate, effort "
                  "and power are recorded, the first ones in the deck, in this order."),
       integer("history_coordinates")
           .at_least(0)
           .otherwise("0")
           .about("Number of joints whose coordinates (angle, displacement, length, angle_1, angle_2) and "
                  "their rates are recorded, the first ones in the deck that have coordinates, with or "
                  "without an effort on them."),
       integer("history_bushings")
           .at_least(0)
           .otherwise("100")
           .about("Number of bushings whose deflection and load are recorded, the first ones in the deck."),
       integers("history_particles")
           .at_least(0)
           .otherwise("[]")
           .about("Particles whose motion is recorded, with their angular velocities where particles rotate: "
                  "indices in the deck's order, from 0."),
       tables("history_regions", history_region_keys())},
      ""};
  return keys;
}

}  // namespace scree
