/* SPDX-License-Identifier: BSD-2-Clause */
/* peak_kernel.h - the loop of peak_avx2.c and peak_avx512.c: PEAK is its name, CHANGE tells the compiler that a register changes. */
TARGET int64_t PEAK(int64_t pairs)
{
    const vec c0 = set(-2.4), c1 = set(-0.4), c2 = set(1.9), x = set(1), y = set(0.1), z = set(0.2), force = set(0.3);
    vec bx = set(0), by = set(1), bz = set(0), bf = set(0.5), bu = set(0), sum = set(0), closest = set(4);
    int64_t done = 0;
    for (; done < pairs; done += LANES) {
        CHANGE(bx);
        CHANGE(by);
        CHANGE(bz);
        CHANGE(bf);
        CHANGE(bu);
        const vec dx = sub(x, bx), dy = sub(y, by), dz = sub(z, bz);
        const vec t = muladd(dz, dz, muladd(dy, dy, muladd(dx, dx, set(TINY))));
        const vec k = muladd(reciprocal_root(t), muladd(c2, t, c0), c1);
        closest = min(closest, t);
        sum = muladd(k, bf, sum);
        vec u = muladd(k, force, bu);
        CHANGE(u);
    }
    CHANGE(sum);
    CHANGE(closest);
    return done;
}
