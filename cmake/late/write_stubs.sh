#!/bin/sh
# write_stubs.sh LIBRARY PACKAGE LIST: prints assembler for x86-64 with a stub for each function
# that LIST names, one a line, as the linker and c++filt write it. All must be exported by LIBRARY, a
# shared library, which the stubs load at the first call of any of them (base/files/late_library.hpp).
set -eu
export LC_ALL=C
library=$1
package=$2
list=$3

exported=$(mktemp)
trap 'rm -f "$exported"' EXIT
nm -D --defined-only "$library" | awk '$2 == "T" || $2 == "W" || $2 == "i" { sub(/@.*/, "", $3); print $3 }' > "$exported"
soname=$(objdump -p "$library" | awk '$1 == "SONAME" { print $2 }')

c++filt < "$exported" | paste "$exported" - | awk -F '\t' -v soname="$soname" -v package="$package" \
    -v list="$list" '
  BEGIN {
    count = 0
    while ((getline line < list) > 0) if (line != "" && line !~ /^#/) wanted[line] = 1
    print "  .text"
  }
  # Constructors and destructors have several symbols of one name; the program may call any.
  $2 in wanted {
    found[$2] = 1
    symbols[count] = $1
    printf "  .globl %s\n  .hidden %s\n  .type %s, @function\n%s:\n", $1, $1, $1, $1
    printf "  .cfi_startproc\n  jmp *slot_%d(%%rip)\nfirst_%d:\n", count, count
    printf "  pushq $%d\n  .cfi_adjust_cfa_offset 8\n  jmp load\n  .cfi_endproc\n", count
    printf "  .size %s, .-%s\n", $1, $1
    ++count
  }
  END {
    for (line in wanted)
      if (!(line in found)) {
        print "error: " list ": got " line ", want a function that " soname " exports" > "/dev/stderr"
        missing = 1
      }
    if (missing) exit 1
    # Arguments stay as they are while the function is searched; an exception passes through.
    split("rdi rsi rdx rcx r8 r9 rax r10", kept, " ")
    print "load:\n  .cfi_startproc\n  .cfi_def_cfa_offset 16"
    for (i = 1; i <= 8; ++i) printf "  pushq %%%s\n  .cfi_adjust_cfa_offset 8\n", kept[i]
    print "  subq $128, %rsp\n  .cfi_adjust_cfa_offset 128"
    for (i = 0; i < 8; ++i) printf "  movups %%xmm%d, %d(%%rsp)\n", i, 16 * i
    print "  leaq library(%rip), %rdi\n  movq 192(%rsp), %rsi\n  call roadbook_late_function"
    print "  movq %rax, %r11"
    for (i = 0; i < 8; ++i) printf "  movups %d(%%rsp), %%xmm%d\n", 16 * i, i
    print "  addq $128, %rsp\n  .cfi_adjust_cfa_offset -128"
    for (i = 8; i >= 1; --i) printf "  popq %%%s\n  .cfi_adjust_cfa_offset -8\n", kept[i]
    print "  addq $8, %rsp\n  .cfi_adjust_cfa_offset -8\n  jmp *%r11\n  .cfi_endproc"

    print "  .section .rodata"
    for (i = 0; i < count; ++i) printf "name_%d: .string \"%s\"\n", i, symbols[i]
    printf "soname: .string \"%s\"\npackage: .string \"%s\"\n", soname, package
    print "  .data\n  .balign 8"
    print "library: .quad soname, package, slots, names, 0"
    print "slots:"
    for (i = 0; i < count; ++i) printf "slot_%d: .quad first_%d\n", i, i
    print "names:"
    for (i = 0; i < count; ++i) printf "  .quad name_%d\n", i
    print "  .section .note.GNU-stack, \"\", @progbits"
  }'
