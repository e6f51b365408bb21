# SPDX-License-Identifier: BSD-2-Clause
"""Recipe for Spack.  It looks for nlcontact-VERSION.tar.gz, which `make dist` makes, where spack is run:

    spack repo create nlc                                   (once; then: spack repo add nlc)
    mkdir nlc/packages/nlcontact                            (below the folder that spack repo create names)
    cp packaging/package.py nlc/packages/nlcontact/
    spack install --no-checksum nlcontact

Built with Spack 0.23; in Spack 1.0 the base class has moved.
"""
import os

try:  # since Spack 1.0
    from spack_repo.builtin.build_systems.makefile import MakefilePackage
except ImportError:
    pass
from spack.package import *


class Nlcontact(MakefilePackage):
    """Nonlocal normal contact forces between elastic spheres: a C library for discrete element codes that computes the coupled
    forces of dense packings from overlaps and contact normals."""

    url = "file://{0}/nlcontact-0.1.0.tar.gz".format(os.getcwd())
    manual_download = True
    license("BSD-2-Clause")

    version("0.1.0")

    depends_on("c", type="build")

    @property
    def build_targets(self):
        return ["lib"]

    @property
    def install_targets(self):
        # libraries in lib, whatever the system prefers: Spack's own prefix
        return ["install", "PREFIX={0}".format(self.prefix)]

    @property
    def libs(self):
        return find_libraries("libnlcontact", root=self.prefix, shared=True, recursive=True)
