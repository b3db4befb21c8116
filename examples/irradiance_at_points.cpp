// SPDX-License-Identifier: Apache-2.0
// irradiance_at_points SCENE: for each line "x y z nx ny nz" of standard input, a point in metres and a unit
// normal, prints the irradiance there in W/m²: red, green and blue.
#include <nearlight/nearlight.h>

#include <exception>
#include <iostream>
#include <vector>

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: irradiance_at_points SCENE\n";
        return 2;
    }
    try {
        std::vector<nearlight::Vec3> points;
        std::vector<nearlight::Vec3> normals;
        for (nearlight::Vec3 p{}, n{}; std::cin >> p.x >> p.y >> p.z >> n.x >> n.y >> n.z;) {
            points.push_back(p);
            normals.push_back(n);
        }
        nearlight::Session session(nearlight::Devices::choose(), nearlight::Scene::load(argv[1]));

        // VPLs from light walks are spread over the whole scene, wherever the camera looks.
        const nearlight::View view = session.look();
        const nearlight::VplSet vpls =
            session.sample(view, {.sampler = nearlight::SamplerKind::instant_radiosity, .vpl_count = 2000});
        for (const nearlight::Vec3 e :
             session.irradiance(points, normals, vpls, {.direct_samples = 256, .paths = 64})) {
            std::cout << e.x << " " << e.y << " " << e.z << "\n";
        }
    } catch (const std::exception& error) {
        std::cerr << "error: " << error.what() << "\n";
        return 1;
    }
}
