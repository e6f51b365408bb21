set -e
S=${1:-/work/main}; out=${2:-/tmp/q/drv}
cd $S
gcc -std=gnu11 -O2 -g -fopenmp -ffp-contract=off -fno-math-errno -fno-omit-frame-pointer -iquote lib -Iinclude -Ibench lib/*.c lib/x86/*.c bench/packing_io.c bench/neighbours.c bench/ordered.c bench/timing.c /tmp/q/drv.c -o $out -lm
