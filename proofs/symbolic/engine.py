"""Symbolic execution of the compiled harness with angr: all paths, or the first one that fails.

angr executes the machine code of `toposlam_symbolic::run`. Each choice is a symbol. Where the code branches
on symbols, both ways that have a solution are followed, each with its condition.

angr chooses values for symbolic lengths and addresses, and so leaves paths out. Here a symbolic length or
address is split: each of its values is a path. One with too many values ends the run without a verdict, and
so does a call of any function of the C library that is not modelled here.
"""

import gc
import logging
import re
import time
from dataclasses import dataclass, field

logging.disable(logging.CRITICAL)

import angr  # noqa: E402, it logs while it is imported
import claripy  # noqa: E402

# The most values that a symbolic length or address may have.
MOST_VALUES = 256
# The most bytes of one allocation. A larger one is an error: no harness has input that deserves it.
MOST_ALLOCATED = 1 << 20
# The functions that end a path with an error; Rust's `abort` is called by none but these.
PANICS = "core9panicking|rust_begin_unwind|11begin_panic|18handle_alloc_error|7process5abort|14abort_internal"
HEAP = 0x7000_0000_0000
RETURN = 0x6FFF_FFFF_0000


class UnknownError(Exception):
    """The run cannot go on, so there is no verdict."""


# A state has many objects that live as long as it: looking for garbage among them is in vain.
gc.set_threshold(200_000, 50, 1000)

NO_VERDICT = (UnknownError, angr.errors.AngrError, angr.errors.SimError, claripy.errors.ClaripyError)


class SeveralAddressesError(Exception):
    """The code uses an address that has several values."""

    def __init__(self, address):
        super().__init__()
        self.address = address


class OneAddress(angr.concretization_strategies.SimConcretizationStrategy):
    """The only value of a symbolic address."""

    def _concretize(self, memory, addr, **kwargs):
        found = self._eval(memory, addr, 2, **kwargs)
        if len(found) > 1:
            raise SeveralAddressesError(addr)
        return found


@dataclass
class Result:
    """The paths of a harness, by outcome."""

    seconds: float = 0.0
    steps: int = 0
    paths: dict = field(default_factory=dict)
    # The input of the first path that fails, and where it fails.
    failing: list = None
    failure: str = None
    # Why there is no verdict.
    unknown: str = None

    @property
    def count(self):
        return sum(self.paths.values())


class Engine:
    """A compiled harness."""

    def __init__(self, binary):
        self.project = angr.Project(str(binary), auto_load_libs=False, main_opts={"base_addr": 0x40_0000})
        self.run = self.only("17toposlam_symbolic3run17h")
        self.replaced = {
            self.only("15toposlam_proofs5input9any_below17h"): any_below,
            self.only("15toposlam_proofs5input8any_byte17h"): any_byte,
        }
        self.ends = {}
        for symbol in self.project.loader.main_object.symbols:
            if symbol.is_function and not symbol.is_import and re.search(PANICS, symbol.name):
                self.ends[symbol.rebased_addr] = symbol.name

    def only(self, part):
        """The address of the only function whose name has this part."""
        symbols = (symbol for symbol in self.project.loader.main_object.symbols if part in symbol.name)
        (address,) = {symbol.rebased_addr for symbol in symbols}
        return address

    def start(self, number):
        """The state at the beginning of a harness."""
        state = self.project.factory.call_state(
            self.run,
            number,
            ret_addr=RETURN,
            add_options={
                angr.options.SYMBOL_FILL_UNCONSTRAINED_MEMORY,
                angr.options.SYMBOL_FILL_UNCONSTRAINED_REGISTERS,
            },
            remove_options=angr.options.simplification,
        )
        state.memory.read_strategies = [OneAddress()]
        state.memory.write_strategies = [OneAddress()]
        state.globals["choices"] = ()
        state.globals["heap"] = HEAP
        state.globals["blocks"] = ()
        return state

    def explore(self, number, seconds):
        """Explores all paths of a harness, for at most this many seconds of processor time."""
        result = Result()
        began = time.process_time()
        stack = [self.start(number)]
        try:
            while stack:
                if time.process_time() - began > seconds:
                    raise UnknownError(f"{seconds} seconds are over")
                state = stack.pop()
                if state.addr == RETURN:
                    self.leaf(state, result)
                elif state.addr in self.ends:
                    result.failing, result.failure = chosen(state), self.ends[state.addr]
                    break
                else:
                    result.steps += 1
                    stack.extend(self.after(state))
        except NO_VERDICT as error:
            result.unknown = f"{type(error).__name__}: {error}"
        result.seconds = time.process_time() - began
        return result

    def caller(self, state):
        """The name of the function to which this one returns."""
        address = state.solver.eval(state.memory.load(state.regs.rsp, 8, endness="Iend_LE"))
        symbol = self.project.loader.find_symbol(address, fuzzy=True)
        return symbol.name if symbol else hex(address)

    def leaf(self, state, result):
        """Counts a path that has returned."""
        outcomes = state.solver.eval_upto(state.regs.al, 8)
        for outcome in outcomes:
            result.paths[outcome] = result.paths.get(outcome, 0) + 1

    def after(self, state):
        """The states after one block, or after one function that is replaced."""
        function = self.replaced.get(state.addr)
        if self.project.is_hooked(state.addr):
            name = self.project.hooked_by(state.addr).display_name
            function = C_LIBRARY.get(name)
            if function is None:
                raise UnknownError(f"{self.caller(state)} calls {name}")
        if function is not None:
            return function(state)
        try:
            successors = self.project.factory.successors(state)
        except SeveralAddressesError as error:
            return [one for one, _ in values_of(state, error.address)]
        if successors.unconstrained_successors:
            raise UnknownError(f"a jump with too many targets at {state.addr:#x}")
        for after in successors.flat_successors:
            if after.history.jumpkind not in ("Ijk_Boring", "Ijk_Call", "Ijk_Ret"):
                raise UnknownError(f"{after.history.jumpkind} at {state.addr:#x}")
        return successors.flat_successors


def chosen(state):
    """The bytes of one input that takes this path."""
    choices = state.globals["choices"]
    # An empty concatenation has no value.
    return list(state.solver.eval(claripy.Concat(*choices), cast_to=bytes)) if choices else []


# Functions that are replaced: each takes the state at its beginning, and returns the states after it.


def returned(state, value):
    """The state after the function has returned this value."""
    if value is not None:
        state.regs.rax = value
    address = state.memory.load(state.regs.rsp, 8, endness="Iend_LE")
    state.regs.rsp += 8
    state.regs.ip = state.solver.eval_one(address)
    return state


def symbol(state):
    """A new symbol of 8 bits."""
    choices = state.globals["choices"]
    choice = claripy.BVS(f"choice{len(choices)}", 8, explicit_name=True)
    state.globals["choices"] = (*choices, choice)
    return choice


def any_byte(state):
    """A new symbol."""
    return [returned(state, symbol(state).zero_extend(56))]


def any_below(state):
    """A new symbol, below the argument."""
    limit = state.regs.dil
    choice = symbol(state)
    state.add_constraints(claripy.ULT(choice, limit))
    return [returned(state, choice.zero_extend(56))] if state.satisfiable() else []


def each_value(*registers):
    """Calls a function for each value of these registers, each with a state of its own."""

    def split(function):
        def splitting(state):
            states = [(state, [])]
            for register in registers:
                states = [
                    (other, [*values, value])
                    for one, values in states
                    for other, value in values_of(one, getattr(one.regs, register))
                ]
            return [function(one, *values) for one, values in states]

        return splitting

    return split


def values_of(state, expression):
    """A state for each value of the expression, with the value."""
    values = state.solver.eval_upto(expression, MOST_VALUES + 1)
    if len(values) > MOST_VALUES:
        raise UnknownError(f"a length, an address or a size has more than {MOST_VALUES} values")
    if len(values) == 1:
        return [(state, values[0])]
    states = [(state.copy(), value) for value in values]
    for one, value in states:
        one.add_constraints(expression == value)
    return states


def allocated(state, size, alignment=16):
    """A block of memory of its own."""
    if size > MOST_ALLOCATED:
        raise UnknownError(f"it allocates {size} bytes")
    block = -(-state.globals["heap"] // alignment) * alignment
    state.globals["heap"] = block + size + 64
    state.globals["blocks"] = (*state.globals["blocks"], (block, size))
    return block


def size_of(state, block):
    """The size of an allocated block."""
    sizes = dict(state.globals["blocks"])
    if block not in sizes:
        raise UnknownError(f"{block:#x} is no block")
    return sizes[block]


@each_value("rdi")
def malloc(state, size):
    return returned(state, allocated(state, size))


@each_value("rdi", "rsi")
def calloc(state, count, size):
    block = allocated(state, count * size)
    fill(state, block, 0, count * size)
    return returned(state, block)


@each_value("rdi", "rsi")
def realloc(state, block, size):
    moved = allocated(state, size)
    copy(state, moved, block, min(size, size_of(state, block)))
    return returned(state, moved)


@each_value("rdi", "rsi", "rdx")
def posix_memalign(state, place, alignment, size):
    block = allocated(state, size, alignment)
    state.memory.store(place, claripy.BVV(block, 64), endness="Iend_LE")
    return returned(state, 0)


@each_value("rdi")
def free(state, block):
    if block:
        size_of(state, block)
        blocks = state.globals["blocks"]
        state.globals["blocks"] = tuple(one for one in blocks if one[0] != block)
    return returned(state, None)


def copy(state, to, source, size):
    if size:
        state.memory.store(to, state.memory.load(source, size))


def fill(state, to, byte, size):
    if size:
        value = claripy.BVV(byte, 8) if isinstance(byte, int) else byte
        state.memory.store(to, claripy.Concat(*[value] * size) if size > 1 else value)


@each_value("rdi", "rsi", "rdx")
def memmove(state, to, source, size):
    copy(state, to, source, size)
    return returned(state, to)


@each_value("rdi", "rdx")
def memset(state, to, size):
    fill(state, to, state.regs.sil, size)
    return returned(state, to)


@each_value("rdi", "rsi", "rdx")
def memcmp(state, one, other, size):
    order = claripy.BVV(0, 32)
    for place in reversed(range(size)):
        left, right = state.memory.load(one + place, 1), state.memory.load(other + place, 1)
        less = claripy.If(claripy.ULT(left, right), claripy.BVV(-1, 32), claripy.BVV(1, 32))
        order = claripy.If(left == right, order, less)
    return returned(state, order.zero_extend(32))


C_LIBRARY = {
    "malloc": malloc,
    "calloc": calloc,
    "realloc": realloc,
    "posix_memalign": posix_memalign,
    "free": free,
    "memcpy": memmove,
    "memmove": memmove,
    "memset": memset,
    "memcmp": memcmp,
    "bcmp": memcmp,
}
