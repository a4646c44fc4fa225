// Keys of what a run writes.
#include "deck/choices.hpp"
#include "deck/keys.hpp"

namespace scree {

const TableKeys& output_keys() {
  static const TableKeys keys{
      "What is written, and how often.",
      {text("directory")
           .otherwise("\"\"")
           .about("Folder of the results, from the folder in which scree is started, not the deck's; empty: "
                  "results/ and the deck's name. --output goes before it. A run with --restart goes on with "
                  "history and snapshots in the folder of its checkpoint, and begins new ones in another."),
       real("snapshot_interval", "s")
           .at_least(0)
           .otherwise("0.0")
           .about("Simulated time between snapshots; 0: only the first and the last state."),
       texts("fields")
           .otherwise("[\"radius\", \"velocity\", \"force\", \"contacts\", \"material\", \"group\"]")
           .about("What snapshots hold of each particle beside its position and its global id; the fields "
                  "that there are stand at the end of this manual. material and group count the names in "
                  "/Scree/materials and /Scree/groups of particles.vtkhdf."),
       texts("surface_fields")
           .otherwise("[\"pressure\", \"shear\"]")
           .about(
               "What snapshots hold of each triangle of the meshes. pressure [Pa] and shear [Pa], a vector: "
               "normal and tangential forces of particles on it at that time over its area. Since t = 0, "
               "added up in each step: impact_work [J], what the damping of normal forces, with the making "
               "of necks, has taken there; sliding_work [J], what friction has; wear_depth [m], the volume "
               "that Archard's law wears off (wear_coefficient of the pairs) over the area. In 2D a segment "
               "of a line is two triangles: both have what there is per length of the segment [N/m], of a "
               "line that is 1 m deep; a work is at one of the two."),
       boolean("contacts")
           .otherwise("false")
           .about("Whether snapshots hold the contacts of particles and of bodies' discs and spheres, a line "
                  "for each (contacts.vtkhdf), with its forces, overlap and partners."),
       boolean("links").otherwise("true").about(
           "Whether snapshots hold the joints, spring-dampers and bushings, a line for each "
           "(links.vtkhdf), with its force and torque."),
       real("history_interval", "s")
           .at_least(0)
           .otherwise("0.0")
           .about("Simulated time between history samples, at its multiples; the start and the end of a run "
                  "have "
                  "one, too. 0: every step."),
       real("checkpoint_interval", "s")
           .at_least(0)
           .otherwise("0.0")
           .about("Simulated time between checkpoints; 0: none of these."),
       real("checkpoint_wall_interval", "s")
           .at_least(0)
           .otherwise("600.0")
           .about(
               "Time on the clock on the wall after which a checkpoint is written where there was none; 0: "
               "none of these. On failure and on a signal there is one in any case."),
       integer("compression")
           .within(0, 9)
           .otherwise("0")
           .about("Of snapshots and checkpoints: 0, none; 1 to 9, deflate from fast to small."),
       boolean("history_csv").otherwise("false").about("Whether the history is also written as CSV."),
       texts("history_bodies").otherwise("[]").about("Bodies, or rows of bodies, whose motion is recorded."),
       texts("history_contacts")
           .otherwise("[]")
           .about(
               "Bodies, rows of bodies, meshes of bodies (\"bucket.teeth\"), walls and sides that are walls "
               "(\"x_min\") on which the contact force is recorded, with its torque and the number of "
               "contacts. Torques are about a body's centre, a wall's point, where that has come (a side's: "
               "space.min or space.max; a mesh's: its origin), and for a row, whose bodies are summed, about "
               "the origin."),
       integer("history_reactions")
           .at_least(0)
           .otherwise("100")
           .about("Joints, drivers and couplers whose reactions are recorded: the first so many of the deck. "
                  "They follow from places, velocities and forces at the instant, whatever the steps before "
                  "it were. A coupler's is that on the second body of its first joint."),
       integer("history_efforts")
           .at_least(0)
           .otherwise("100")
           .about(
               "Motors, springs, limits and friction on joints whose coordinate, rate, effort and power are "
               "recorded: the first so many of the deck, in this order."),
       integer("history_coordinates")
           .at_least(0)
           .otherwise("0")
           .about("Joints whose coordinates and their rates are recorded: the first so many of the deck that "
                  "have coordinates (angle, displacement, length, angle_1, angle_2), with or without an "
                  "effort on "
                  "them."),
       integer("history_bushings")
           .at_least(0)
           .otherwise("100")
           .about("Bushings whose deflection and load are recorded: the first so many of the deck."),
       integers("history_particles")
           .at_least(0)
           .otherwise("[]")
           .about("Particles whose motion is recorded, with their spins where particles rotate: numbers in "
                  "the deck's order, from 0.")},
      ""};
  return keys;
}

}  // namespace scree
