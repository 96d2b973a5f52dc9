# SPDX-License-Identifier: MPL-2.0
"""The C++ headers for Conan 2: conan create packaging/conan."""

import re
from pathlib import Path

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake
from conan.tools.files import copy


class Revchain(ConanFile):
    name = "revchain"
    description = "Whirl speeds, shapes and error bounds of chains of links that turn about a vertical axis"
    license = ("MPL-2.0", "GPL-3.0-or-later")
    topics = ("chain", "conical pendulum", "rotordynamics", "eigenvalues")
    package_type = "header-library"
    settings = ("os", "arch", "compiler", "build_type")
    options = {"analytic": [True, False]}
    default_options = {"analytic": False}
    generators = ("CMakeDeps", "CMakeToolchain")
    no_copy_source = True

    @property
    def _root(self):
        return Path(self.recipe_folder).parents[1]

    def set_version(self):
        self.version = re.search(r"project\(revchain VERSION ([\d.]+)", (self._root / "CMakeLists.txt").read_text())[1]

    # A recipe of a release has conandata.yml and source() with get() instead, and its version there.
    def export_sources(self):
        for pattern in ("CMakeLists.txt", "cmake/*", "include/*", "src/compiled/*", "LICENSES/*"):
            copy(self, pattern, self._root, self.export_sources_folder)

    def requirements(self):
        self.requires("eigen/[>=3.4 <6]", transitive_headers=True)
        if self.options.analytic:
            self.requires("gsl/[>=2.7]", transitive_headers=True, transitive_libs=True)

    def package_id(self):
        self.info.settings.clear()

    def validate(self):
        check_min_cppstd(self, 20)

    def build(self):
        cmake = CMake(self)
        cmake.configure(
            {
                "REVCHAIN_ANALYTIC": bool(self.options.analytic),
                "REVCHAIN_BUILD_TESTS": False,
                "REVCHAIN_BUILD_EXAMPLES": False,
            }
        )

    def package(self):
        CMake(self).install()
        copy(self, "*PL-*.txt", Path(self.source_folder) / "LICENSES", Path(self.package_folder) / "licenses")

    def package_info(self):
        # Programs find the installed CMake configuration, as without Conan.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["share/cmake/revchain"]
        self.cpp_info.bindirs = self.cpp_info.libdirs = []
        if self.settings.os in ("Linux", "FreeBSD"):
            self.cpp_info.system_libs = ["pthread"]
