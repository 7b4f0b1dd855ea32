"""Counts the instructions of the lattice's vector loops, and times each loop alone.

    cargo bench -p wakemix-benches --bench lattice --no-run    # prints the path of the binary
    python3 benches/count.py BINARY [LLVM-MCA]

Needs objdump, cc, and an x86-64 machine with AVX-512 to time on. Three figures of cycles per vector of sixteen
cells stand beside the counts:

* alone: the loop's vector instructions in their order, every address put into the first-level cache, the
  loop's own integer instructions left out. What is left is the core: ports, latencies, and how far it looks ahead.
* unbound: the same instructions without their dependencies, which leaves the ports.
* model: llvm-mca for Sapphire Rapids, where its path is given (version 16 or newer; older ones know the
  name but take the figures of Skylake). A model, not a measurement.

Cycles are of the clock that a chain of additions shows at that moment; the best of 600 runs of 500 rounds.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

KINDS = [
    ("add", r"v(add|sub)ps"),
    ("mul", r"vmulps"),
    ("fma", r"vfn?m(add|sub)\w*ps"),
    ("div", r"vdivps"),
    ("root", r"vsqrtps"),
    ("ask", r"prefetch"),
]
MEMORY = re.compile(r"(-?(?:0x)?[0-9a-f]*)\((%[^)]*)\)")
TIMER = r"""
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
void hot(long n, void *memory);
static double now(void) { struct timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }
static void adds(long n) {
    long a = 1;
    __asm__ volatile("1: add %0,%0\nadd %0,%0\nadd %0,%0\nadd %0,%0\ndec %1\njnz 1b" : "+r"(a), "+r"(n));
}
int main(void) {
    char *memory = aligned_alloc(4096, 65536);
    for (int i = 0; i < 16384; i++) ((float *)memory)[i] = 0.0f;
    double clock = 1e9, best = 1e9;
    for (int r = 0; r < 300; r++) { double t = now(); adds(40000); t = now() - t; if (t < clock) clock = t; }
    for (int r = 0; r < 600; r++) { double t = now(); hot(500, memory); t = now() - t; if (t < best) best = t; }
    printf("%.0f", best * (160000 / clock) / 500);
}
"""


def functions(binary):
    """Bodies of the sweeps: lists of (address, instruction)."""
    text = subprocess.run(["objdump", "-d", "--no-show-raw-insn", "-C", binary],
                          capture_output=True, text=True, check=True).stdout
    for part in text.split("\n\n"):
        head, _, body = part.strip().partition("\n")
        if "Kernel::new::sweep" in head:
            yield [(int(a, 16), re.split(r"\s*[#<]", i)[0].strip())
                   for a, i in re.findall(r"^\s*([0-9a-f]+):\s+(.*)$", body, re.M)]


def loops(body):
    """Innermost loops of sixteen lanes that hold a whole cell update of D3Q19."""
    place = {address: index for index, (address, _) in enumerate(body)}
    found = []
    for index, (_, text) in enumerate(body):
        jump = re.match(r"j\w+\s+([0-9a-f]+)$", text)
        start = place.get(int(jump[1], 16)) if jump else None
        if start is not None and start <= index:
            found.append((start, index))
    for start, end in found:
        if any(other != (start, end) and start <= other[0] and other[1] <= end for other in found):
            continue
        lines = [text for _, text in body[start:end + 1]]
        stores = [line for line in lines if is_store(line) and "%rsp" not in line]
        if sum("zmm" in line for line in lines) > 200 and len(stores) >= 19:
            yield body[start][0], lines


def is_store(line):
    return bool(re.match(r"vmov\w+ %zmm\d+,[^,]*\(.*\)$", re.sub(r"\s+", " ", line)))


def count(lines):
    counts = {"all": len(lines)}
    for name, pattern in KINDS:
        counts[name] = sum(bool(re.match(pattern, line)) for line in lines)
    vector = [line for line in lines if line.startswith("v") and MEMORY.search(line)]
    writes = [line for line in vector if is_store(line)]
    reads = [line for line in vector if not is_store(line) and "{1to" not in line and "broadcast" not in line]
    counts["load"] = sum("%rsp" not in line for line in reads)
    counts["store"] = sum("%rsp" not in line for line in writes)
    counts["stack"] = sum("%rsp" in line for line in reads + writes)
    return counts


def alone(lines, dependent):
    """The loop's vector instructions on memory of their own."""
    slots, out = {}, []
    for line in lines:
        name = line.split()[0]
        if not (name.startswith("v") or name.startswith("prefetch")):
            continue
        memory = MEMORY.search(line)
        if memory:
            slot = slots.setdefault(memory[0], 64 * len(slots))
            line = f"{line[:memory.start()]}{slot}(%rsi){line[memory.end():]}"
        if not dependent and re.match(r"v(add|sub|mul|fm|fnm)", name):
            line = f"{re.sub('132|213', '231', name)} %zmm30,%zmm31,%zmm{len(out) % 24}"
        out.append(line)
    return out


def measured(lines, folder):
    zero = "\n".join(f"vmovaps %zmm0,%zmm{k}" for k in range(16, 32))
    code = "\n".join(lines)
    (folder / "hot.s").write_text(f".text\n.globl hot\nhot:\nvzeroall\n{zero}\n1:\n{code}\ndec %rdi\njnz 1b\n"
                                  'vzeroupper\nret\n.section .note.GNU-stack,"",@progbits\n')
    (folder / "timer.c").write_text(TIMER)
    program = folder / "timer"
    subprocess.run(["cc", "-O2", "-o", program, folder / "timer.c", folder / "hot.s"], check=True)
    return subprocess.run([program], capture_output=True, text=True, check=True).stdout


def modelled(lines, mca):
    code = "\n".join(re.sub(r"^(j\w+).*", r"\1 .", line) for line in lines)
    text = subprocess.run([mca, "-mcpu=sapphirerapids", "-iterations=200"], input=f".text\n{code}\n",
                          capture_output=True, text=True, check=True).stdout
    return f"{int(re.search(r'Total Cycles: +([0-9]+)', text)[1]) / 200:.0f}"


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as folder:
        for body in functions(sys.argv[1]):
            for address, lines in loops(body):
                counts = " ".join(f"{name} {value}" for name, value in count(lines).items())
                cycles = f"alone {measured(alone(lines, True), Path(folder))}" \
                         f", unbound {measured(alone(lines, False), Path(folder))}"
                if len(sys.argv) == 3:
                    cycles += f", model {modelled(lines, sys.argv[2])}"
                print(f"loop {address:x}: {counts}; cycles {cycles}")


if __name__ == "__main__":
    main()
