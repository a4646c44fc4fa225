"""Pictures of a run: discs in the plane, lit spheres in space, with bodies, walls, joints and meshes."""
