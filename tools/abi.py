#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""What the ABI of a release is, for tests/abi (`make abi-baseline` runs this):

    python3 tools/abi.py header include/nlcontact.h                         the header without its comments
    python3 tools/abi.py layout include/nlcontact.h lib/nlcontact.map [CC]  sizes, offsets, values and symbols, a line each
    python3 tools/abi.py symbols lib/nlcontact.map                          Debian's list of symbols

Offsets are the compiler's, for three models of data: 64 bits; 32 bits with int64_t and double aligned to 8 bytes (ARM and
others), and to 4 (i386).  A field stands as offset+size.
"""
import os
import re
import subprocess
import sys
import tempfile

MODELS = ([], ['-mx32'], ['-m32'])


def read(name):
    with open(name, encoding='utf-8') as file:
        return file.read()


def without_comments(text):
    text = re.sub(r'/\*.*?\*/', '', text, flags=re.S)
    return re.sub(r'\n{3,}', '\n\n', re.sub(r'[ \t]+$', '', text, flags=re.M))


def structs(text):
    """Yields the name of each public struct and those of its fields, pointers to functions included."""
    for body, name in re.findall(r'typedef struct \w+ \{(.*?)\} (\w+);', without_comments(text), flags=re.S):
        fields = []
        for declaration in body.split(';'):
            pointer = re.search(r'\(\s*\*\s*(\w+)\s*\)\s*\(', declaration)
            fields += [pointer.group(1)] if pointer else re.findall(r'(\w+)\s*(?:\[\w*\])?\s*(?:,|$)', declaration.strip())
        yield name, fields


def measure(header, expressions, cc, flags):
    """The values of constant expressions > 0, from the sizes of arrays in an object that need not run."""
    with tempfile.TemporaryDirectory() as folder:
        source, target = os.path.join(folder, 'sizes.c'), os.path.join(folder, 'sizes.o')
        with open(source, 'w', encoding='utf-8') as file:
            file.write('#include "%s"\n' % os.path.abspath(header))
            file.writelines('char v%d[%s];\n' % pair for pair in enumerate(expressions))
        subprocess.run([*cc.split(), *flags, '-ffreestanding', '-fno-common', '-c', '-o', target, source], check=True)
        lines = subprocess.run(['nm', '-P', target], check=True, capture_output=True, text=True).stdout.splitlines()
    found = {words[0]: int(words[3], 16) for words in map(str.split, lines)}
    return [found['v%d' % k] for k in range(len(expressions))]


def nodes(text):
    """The nodes of the version script, oldest first, each with its symbols."""
    return [(name, re.findall(r'^\s*(nlc_\w+);', body, flags=re.M))
            for name, body in re.findall(r'^(NLCONTACT_[\d.]+) \{(.*?)^\}', text, flags=re.S | re.M)]


def layout(header, version_script, cc='gcc'):
    text = read(header)
    rows = []
    for name, fields in structs(text):
        rows.append(('struct ' + name, 'sizeof(%s)' % name, None))
        for f in fields:
            rows.append(('field %s.%s' % (name, f), 'offsetof(%s, %s) + 1' % (name, f), 'sizeof ((%s *)0)->%s' % (name, f)))
    expressions = [r[1] for r in rows] + [r[2] or '1' for r in rows]
    columns = [measure(header, expressions, cc, flags) for flags in MODELS]
    print('# made by tools/abi.py: 64 bits, 32 bits, i386; a field as offset+size')
    for k, (name, _, size) in enumerate(rows):
        cells = ['%d+%d' % (c[k] - 1, c[k + len(rows)]) if size else str(c[k]) for c in columns]
        print('%-40s %8s %8s %8s' % (name, *cells))
    plain = without_comments(text)
    values = re.findall(r'^\s*(NLC_[A-Z0-9_]+) *= *(-?\w+)', plain, flags=re.M)
    values += re.findall(r'X\((NLC_[A-Z0-9_]+), *(-?\d+),', plain)
    for name, value in values:
        print('value %s %s' % (name, value))
    for node, symbols in nodes(read(version_script)):
        for symbol in symbols:
            print('symbol %s %s' % (symbol, node))


def debian_symbols(version_script):
    print('libnlcontact.so.0 libnlcontact0 #MINVER#\n* Build-Depends-Package: libnlcontact-dev')
    lines = []
    for node, symbols in nodes(read(version_script)):
        release = node.split('_')[1]
        lines += ['%s@%s %s' % (s, node, release) for s in [node] + symbols]
    for line in sorted(lines):
        print(' ' + line)


def main():
    commands = {'header': lambda name: print(without_comments(read(name)).strip()), 'layout': layout, 'symbols': debian_symbols}
    if len(sys.argv) < 3 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    commands[sys.argv[1]](*sys.argv[2:])


if __name__ == '__main__':
    main()
