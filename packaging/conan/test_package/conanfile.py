# SPDX-License-Identifier: MPL-2.0
"""Builds and runs programs of tests/install against the package; Conan does so after it has created one."""

import os
from pathlib import Path

from conan import ConanFile
from conan.tools.build import can_run
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout


class Consumers(ConanFile):
    settings = ("os", "arch", "compiler", "build_type")

    def requirements(self):
        self.requires(self.tested_reference_str)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        toolchain.user_presets_path = ""  # writes nothing into tests/install
        toolchain.generate()

    def _consumer(self):
        return "analytic" if self.dependencies["revchain"].options.analytic else "light"

    def build(self):
        cmake = CMake(self)
        cmake.configure(build_script_folder=Path(self.recipe_folder).parents[2] / "tests/install" / self._consumer())
        cmake.build()

    def test(self):
        if can_run(self):
            self.run(os.path.join(self.cpp.build.bindir, "consumer"), env="conanrun")
