"""Scree for Spack. A folder packages/scree with this file in a repository of yours, or the one of this tree's checkout:

    spack dev-build -d TREE scree@0.1.0         # TREE: this source tree; no archive of it is fetched
"""

from spack.package import *


class Scree(CMakePackage, CudaPackage):
    """Collisions between a constrained multibody system and very many particles, on CPU cores and NVIDIA GPUs."""

    license("MIT")

    version("0.1.0")

    variant("klu", default=True, description="Refactor the bodies' matrices with SuiteSparse's KLU")
    variant("parallel_hdf5", default=True, description="All ranks write at once; otherwise rank 0 writes for all")
    variant("nccl", default=False, when="+cuda", description="Ghosts may travel between GPUs by NCCL")

    depends_on("c", type="build")
    depends_on("cxx", type="build")
    depends_on("cmake@3.24:", type="build")
    depends_on("ninja", type="build")
    depends_on("pkgconfig", type="build")
    depends_on("python@3:", type="build")
    depends_on("mpi")
    depends_on("petsc@3.18: +mpi +double ~complex")
    depends_on("petsc +suite-sparse", when="+klu")
    depends_on("suite-sparse", when="+klu")
    depends_on("hdf5@1.10: +mpi", when="+parallel_hdf5")
    depends_on("hdf5@1.10: ~mpi", when="~parallel_hdf5")
    depends_on("eigen@3.4:3")
    depends_on("tomlplusplus")
    depends_on("cli11")
    depends_on("fmt")
    depends_on("cuda@12:", when="+cuda")
    depends_on("nccl", when="+nccl")

    conflicts("%gcc@:10", msg="Scree is written in C++20")
    conflicts("cuda_arch=none", when="+cuda", msg="+cuda wants cuda_arch=80, 90, ...")

    generator("ninja")

    def cmake_args(self):
        args = [
            self.define("SCREE_NATIVE", False),  # the target is Spack's to choose
            self.define("SCREE_TESTS", False),
            self.define("SCREE_KLU", "ON" if self.spec.satisfies("+klu") else "OFF"),
            self.define("SCREE_PARALLEL_HDF5", "ON" if self.spec.satisfies("+parallel_hdf5") else "OFF"),
            self.define_from_variant("SCREE_CUDA", "cuda"),
        ]
        if self.spec.satisfies("+cuda"):
            args.append(self.define("CMAKE_CUDA_ARCHITECTURES", self.spec.variants["cuda_arch"].value))
        return args

    @run_after("install")
    @on_package_attributes(run_tests=True)
    def check_a_deck(self):
        scree = Executable(join_path(self.prefix.bin, "scree"))
        scree("check", join_path(self.prefix.share, "scree", "input", "examples", "pendulum.toml"))
