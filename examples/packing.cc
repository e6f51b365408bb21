// SPDX-License-Identifier: BSD-2-Clause
// packing.cc - total contact force of a packing (bench/README has the format), by Hertz and with the coupling.
#include "nlcontact.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>

namespace {

const double reach = 0.3; // gaps below this part of the mean radius make a candidate

// A particle as a program might have it: the library reads position, radius and material where they lie.
struct grain {
    double x[3], radius;
    std::int32_t material, id;
};

struct packing {
    std::vector<grain> grains;
    std::vector<nlc_material> materials;
    std::vector<double> wall_point, wall_normal; // three numbers a wall
    std::vector<std::int32_t> wall_material;
};

packing read(const char *path)
{
    packing p;
    std::ifstream file(path);
    std::string line, word;
    if (!file) throw std::runtime_error(std::string("cannot read ") + path);
    while (std::getline(file, line)) {
        std::istringstream words(line);
        double v[6] = {};
        int number;
        const bool periodic = line.compare(0, 11, "# periodic:") == 0 && line.find('1') != std::string::npos;
        const bool wall = line.compare(0, 7, "# wall ") == 0;
        if (periodic || (wall && line.find(" rigid ") == std::string::npos))
            throw std::runtime_error("this example has no periodic boxes and no walls that yield");
        if (wall) {
            words >> word >> word >> word >> word >> word >> word >> v[0] >> v[1] >> v[2] >> word >> v[3] >> v[4] >> v[5];
            p.wall_point.insert(p.wall_point.end(), v, v + 3);
            p.wall_normal.insert(p.wall_normal.end(), v + 3, v + 6);
        } else if (line.compare(0, 16, "# material type ") == 0) {
            words >> word >> word >> word >> number >> word >> word >> v[0] >> word >> v[1];
            p.materials.push_back(nlc_material{v[0], v[1]});
        } else if (std::sscanf(line.c_str(), "%d,%lf,%lf,%lf,%lf,%lf", &number, v, v + 1, v + 2, v + 3, v + 4) == 6) {
            p.grains.push_back(grain{{v[0], v[1], v[2]}, v[3], std::int32_t(v[4]) - 1, number});
        }
    }
    p.wall_material.assign(p.wall_point.size() / 3, std::int32_t(p.materials.size()));
    p.materials.push_back(nlc_material{std::numeric_limits<double>::infinity(), 0}); // the walls': rigid
    return p;
}

// All pairs with a gap below the reach, and all walls: quadratic, where a program has its neighbour lists.
void list(const packing &p, std::vector<std::int32_t> &i, std::vector<std::int32_t> &j)
{
    const auto &g = p.grains;
    for (std::size_t a = 0; a < g.size(); a++) {
        for (std::size_t b = a + 1; b < g.size(); b++) {
            double square = 0;
            for (int k = 0; k < 3; k++) square += (g[b].x[k] - g[a].x[k]) * (g[b].x[k] - g[a].x[k]);
            if (std::sqrt(square) >= (1 + reach / 2) * (g[a].radius + g[b].radius)) continue;
            i.push_back(std::int32_t(a));
            j.push_back(std::int32_t(b));
        }
        for (std::size_t w = 0; w < p.wall_material.size(); w++) {
            double height = 0;
            for (std::size_t k = 0; k < 3; k++) height += (g[a].x[k] - p.wall_point[3 * w + k]) * p.wall_normal[3 * w + k];
            if (height >= (1 + reach) * g[a].radius) continue;
            i.push_back(std::int32_t(a));
            j.push_back(std::int32_t(g.size() + w));
        }
    }
}

double total_force(const packing &p, std::int32_t model)
{
    nlc_particles particles = nlc_particles();
    particles.struct_size = sizeof particles;
    particles.count = std::int64_t(p.grains.size());
    particles.radius = &p.grains[0].radius;
    particles.material = &p.grains[0].material;
    particles.radius_stride = particles.material_stride = sizeof(grain);
    particles.materials = p.materials.data();
    particles.material_count = std::int64_t(p.materials.size());
    particles.wall_material = p.wall_material.data();
    particles.wall_count = std::int64_t(p.wall_material.size());
    nlc_positions positions = nlc_positions();
    positions.struct_size = sizeof positions;
    positions.x = &p.grains[0].x[0];
    positions.y = &p.grains[0].x[1];
    positions.z = &p.grains[0].x[2];
    positions.stride = sizeof(grain);
    positions.wall_point = p.wall_point.data();
    positions.wall_normal = p.wall_normal.data();
    nlc_options options = nlc_options();
    options.struct_size = sizeof options;
    options.model = model;

    std::vector<std::int32_t> i, j;
    list(p, i, j);
    const std::int64_t count = std::int64_t(i.size());
    std::vector<double> overlap(i.size()), normal(3 * i.size()), force(i.size()), nonlocal(i.size());
    nlc::check([&](nlc_info *info) {
        return nlc_contacts_from_pairs(overlap.data(), normal.data(), &particles, &positions, i.data(), j.data(), count, info);
    });
    const nlc::network network(particles, i, j, &options);
    nlc::check([&](nlc_info *info) {
        return nlc_solve(network, force.data(), nonlocal.data(), overlap.data(), normal.data(), info);
    });
    double total = 0;
    for (double f : force) total += f;
    return total;
}

} // namespace

int main(int argc, char **argv)
try {
    if (argc != 2) throw std::runtime_error("usage: packing-c++ FILE.csv");
    const packing p = read(argv[1]);
    const double hertz = total_force(p, NLC_MODEL_HERTZ), coupled = total_force(p, NLC_MODEL_GONZALEZ_CUITINO);
    std::printf("total force: Hertz %.6f N, Gonzalez-Cuitino %.6f N, ratio %.3f\n", hertz, coupled, coupled / hertz);
} catch (const std::exception &e) {
    std::cerr << "packing-c++: " << e.what() << '\n';
    return 1;
}
