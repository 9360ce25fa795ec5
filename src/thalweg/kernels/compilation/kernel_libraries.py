"""LLVM modules of kernels, with less work for the compiler than those of numba.

numba optimises and emits machine code for every function, also for those that only other kernels
call, although their callers take a copy of the module and optimise it again. Here that is done for
kernels with an entry from Python alone: compilation takes about three quarters of the time.
"""

import numba
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler

#: Versions of numba whose internals these classes were tried with; others compile as usual.
TRIED_VERSIONS = ("0.68",)


class EntryLibrary(JITCodeLibrary):
    """The module of a kernel with an entry from Python."""

    def _optimize_functions(self, ll_module):
        ll_module.data_layout = self._codegen._data_layout
        passes, builder = self._codegen._function_pass_manager()
        for function in ll_module.functions:
            if not function.is_declaration:
                passes.run(function, builder)


class InnerLibrary(EntryLibrary):
    """The module of a kernel that only kernels call."""

    @property
    def codegen(self):
        """Stands for the code generator, which has no machine code of this module."""
        return self

    def set_env(self, name, environment):
        """Leave the environment of the function: it has no address, and kernels do not use it."""

    def _optimize_final_module(self):
        """Leave the module to its callers; its functions have been optimised one by one."""

    def _finalize_final_module(self):
        self._finalize_dynamic_globals()
        self._finalized = True

    def serialize_using_object_code(self):
        """Return the module for the cache on disk."""
        return self.serialize_using_bitcode()


class EntryCompiler(Compiler):
    """Compiles into an `EntryLibrary`."""

    library_class = EntryLibrary

    def compile_extra(self, func):
        """Compile a function."""
        library = self.library_class(self.state.targetctx.codegen(), func.__qualname__)
        library.enable_object_caching()
        self.state.library = library
        return super().compile_extra(func)


class InnerCompiler(EntryCompiler):
    """Compiles into an `InnerLibrary`."""

    library_class = InnerLibrary


def entry_compiler():
    """Return the compiler of kernels with an entry from Python."""
    return EntryCompiler if numba.__version__.startswith(TRIED_VERSIONS) else Compiler


def inner_compiler():
    """Return the compiler of kernels that only kernels call."""
    return InnerCompiler if numba.__version__.startswith(TRIED_VERSIONS) else Compiler
