#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The header: compiles alone and without a warning as C and C++ of every age, twice too; public structs have no padding and
# the layout that programs out there were built with.
set -eu
fail() { echo "test_header: $*" >&2; exit 1; }
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT
trap 'exit 1' HUP INT TERM
strict="-Wall -Wextra -pedantic -Wconversion -Wsign-conversion -Wshadow -Wundef -Wpadded -Werror"

printf '#include <nlcontact.h>\n#include <nlcontact.h>\n' >"$tmp/twice.c"
cp "$tmp/twice.c" "$tmp/twice.cc"

# Recorded from 0.1.  A new field is appended and recorded here; nothing else may ever change.
cat >"$tmp/layout.c" <<'EOF'
#include <nlcontact.h>
#define SIZE(type, size, sum) _Static_assert(sizeof(type) == (size) && (sum) == (size), #type " has changed or is padded")
#define AT(type, field, offset) _Static_assert(offsetof(type, field) == (offset), #type "." #field " has moved")
#define OF(type, field) sizeof(((type *)0)->field)
#define VALUE(name, value) _Static_assert((name) == (value), #name " has changed")

#if defined(__LP64__)
#define M(field) OF(nlc_material, field)
SIZE(nlc_material, 16, M(young) + M(poisson));
AT(nlc_material, young, 0);
AT(nlc_material, poisson, 8);

#define P(field) OF(nlc_particles, field)
SIZE(nlc_particles, 88, P(struct_size) + P(count) + P(radius) + P(radius_stride) + P(material) + P(material_stride) +
     P(materials) + P(material_count) + P(material_size) + P(wall_material) + P(wall_count));
AT(nlc_particles, struct_size, 0);
AT(nlc_particles, count, 8);
AT(nlc_particles, radius, 16);
AT(nlc_particles, radius_stride, 24);
AT(nlc_particles, material, 32);
AT(nlc_particles, material_stride, 40);
AT(nlc_particles, materials, 48);
AT(nlc_particles, material_count, 56);
AT(nlc_particles, material_size, 64);
AT(nlc_particles, wall_material, 72);
AT(nlc_particles, wall_count, 80);

#define O(field) OF(nlc_options, field)
SIZE(nlc_options, 88, O(struct_size) + O(model) + O(method) + O(tolerance) + O(max_sweeps) + O(prefactor) + O(simd) +
     O(points) + O(stiffness) + O(cache) + O(cache_size) + O(parallel_for) +
     O(parallel_context));
AT(nlc_options, struct_size, 0);
AT(nlc_options, model, 8);
AT(nlc_options, method, 12);
AT(nlc_options, tolerance, 16);
AT(nlc_options, max_sweeps, 24);
AT(nlc_options, prefactor, 32);
AT(nlc_options, simd, 40);
AT(nlc_options, points, 44);
AT(nlc_options, stiffness, 48);
AT(nlc_options, cache, 56);
AT(nlc_options, cache_size, 64);
AT(nlc_options, parallel_for, 72);
AT(nlc_options, parallel_context, 80);

#define I(field) OF(nlc_info, field)
SIZE(nlc_info, 128, I(struct_size) + I(culprit) + I(sweeps) + I(residual) + I(worst_contact) + I(active) +
     I(lambda_lower) + I(lambda_upper) + I(critical_particle) + I(coupling) + I(weakest_particle) + I(weakened) + I(blocks) +
     I(left_out) + I(clusters) + I(settled));
AT(nlc_info, struct_size, 0);
AT(nlc_info, culprit, 8);
AT(nlc_info, sweeps, 16);
AT(nlc_info, residual, 24);
AT(nlc_info, worst_contact, 32);
AT(nlc_info, active, 40);
AT(nlc_info, lambda_lower, 48);
AT(nlc_info, lambda_upper, 56);
AT(nlc_info, critical_particle, 64);
AT(nlc_info, coupling, 72);
AT(nlc_info, weakest_particle, 80);
AT(nlc_info, weakened, 88);
AT(nlc_info, blocks, 96);
AT(nlc_info, left_out, 104);
AT(nlc_info, clusters, 112);
AT(nlc_info, settled, 120);

#define R(field) OF(nlc_model_record, field)
SIZE(nlc_model_record, 64, R(struct_size) + R(name) + R(reference) + R(doi) + R(validity) + R(symmetric) + R(potential) +
     R(self_term) + R(circles) + R(cost));
AT(nlc_model_record, struct_size, 0);
AT(nlc_model_record, name, 8);
AT(nlc_model_record, reference, 16);
AT(nlc_model_record, doi, 24);
AT(nlc_model_record, validity, 32);
AT(nlc_model_record, symmetric, 40);
AT(nlc_model_record, potential, 44);
AT(nlc_model_record, self_term, 48);
AT(nlc_model_record, circles, 52);
AT(nlc_model_record, cost, 56);

#define X(field) OF(nlc_positions, field)
SIZE(nlc_positions, 64, X(struct_size) + X(x) + X(y) + X(z) + X(stride) + X(wall_point) + X(wall_normal) + X(cell));
AT(nlc_positions, x, 8);
AT(nlc_positions, y, 16);
AT(nlc_positions, z, 24);
AT(nlc_positions, stride, 32);
AT(nlc_positions, wall_point, 40);
AT(nlc_positions, wall_normal, 48);
AT(nlc_positions, cell, 56);

#define L(field) OF(nlc_lists, field)
SIZE(nlc_lists, 56, L(struct_size) + L(count) + L(particle) + L(particle_count) + L(length) + L(neighbour) + L(mask) +
     L(reserved));
AT(nlc_lists, count, 8);
AT(nlc_lists, particle, 16);
AT(nlc_lists, particle_count, 24);
AT(nlc_lists, length, 32);
AT(nlc_lists, neighbour, 40);
AT(nlc_lists, mask, 48);
AT(nlc_lists, reserved, 52);
#endif

VALUE(sizeof(nlc_status), 4);
VALUE(NLC_MODEL_GONZALEZ_CUITINO, 0);
VALUE(NLC_MODEL_HERTZ, 1);
VALUE(NLC_MODEL_HALF_SPACE, 2);
VALUE(NLC_MODEL_LOVE, 3);
VALUE(NLC_MODEL_SPHERE, 4);
VALUE(NLC_MODEL_POINT_FORCE, 5);
VALUE(NLC_METHOD_AUTOMATIC, 0);
VALUE(NLC_METHOD_FIXED_POINT, 1);
VALUE(NLC_POINTS_DEFORMED, 0);
VALUE(NLC_POINTS_UNDEFORMED, 1);
VALUE(NLC_SIMD_BEST, 0);
VALUE(NLC_SIMD_GENERIC, 1);
VALUE(NLC_SIMD_AVX2, 2);
VALUE(NLC_SIMD_AVX512, 3);
VALUE(NLC_SIMD_NEON, 4);
VALUE(NLC_OK, 0);
VALUE(NLC_ERROR_NULL, -1);
VALUE(NLC_ERROR_RANGE, -28);
VALUE(NLC_ERROR_UNSTABLE, -29);
VALUE(NLC_ERROR_SLIDING, -30);
VALUE(NLC_ERROR_CAPACITY, -34);
VALUE(NLC_WARNING_CLOSE, 1);
VALUE(NLC_WARNING_ROUNDING, 2);
VALUE(NLC_WARNING_WEAKENED, 4);
VALUE(NLC_WARNING_NOT_CONVERGED, 8);
EOF

# Every struct of the header must be recorded above.
for type in $(sed -n 's/^typedef struct \(nlc_[a-z_]*\) {.*/\1/p' "$S/include/nlcontact.h"); do
    grep -q "SIZE($type," "$tmp/layout.c" || fail "the layout of $type is not recorded"
done

compiled=0
compile() {
    "$@" -fsyntax-only -I"$S/include" || fail "does not pass: $*"
    compiled=$((compiled + 1))
}
for cc in "$CC" gcc clang; do
    command -v "${cc%% *}" >/dev/null || continue
    case " ${seen-}|" in *" $cc|"*) continue ;; esac
    seen="${seen-} $cc|"
    for std in c99 c11 c17; do compile $cc -std=$std $strict -Wstrict-prototypes "$tmp/twice.c"; done
    compile $cc -std=c11 "$tmp/layout.c"
done
for cxx in "$CXX" g++ clang++; do
    command -v "${cxx%% *}" >/dev/null || continue
    case " ${seen-}|" in *" $cxx|"*) continue ;; esac
    seen="${seen-} $cxx|"
    for std in c++11 c++17; do
        compile $cxx -std=$std $strict -Wold-style-cast -Wzero-as-null-pointer-constant "$tmp/twice.cc"
    done
done

# A C++ program with every function in it links and runs.
names=$(sed -n 's/^NLC_API .*[ *]\(nlc_[a-z0-9_]*\)(.*/\1/p' "$S/include/nlcontact.h")
[ -n "$names" ] || fail "no functions found in the header"
{
    echo '#include <nlcontact.h>'
    echo 'typedef void (*function)();'
    echo 'static const function volatile functions[] = {'
    for name in $names; do echo "    reinterpret_cast<function>(&$name),"; done
    echo '};'
    echo 'int main()'
    echo '{'
    echo '    for (std::size_t k = 0; k < sizeof functions / sizeof *functions; k++) if (!functions[k]) return 1;'
    echo '    return nlc_hertz_force(3.0, 4.0) == 24.0 ? 0 : 1;'
    echo '}'
} | sed '1i #include <cstddef>' >"$tmp/all.cc"
$CXX ${CFLAGS-} -std=c++11 -I"$S/include" -o "$tmp/all" "$tmp/all.cc" "$B/libnlcontact.a" ${LDFLAGS-} -lm ||
    fail "a C++ program with every function in it does not link"
${EMULATOR-} "$tmp/all" || fail "a C++ program computes something else"
echo "test_header: $compiled compilations, 7 structs, a C++ program: ok"
