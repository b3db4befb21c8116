// SPDX-License-Identifier: Apache-2.0
#include <host/image/image_io.h>

#include <iostream>

int main(int, char** argv) {
    const nearlight::core::Image image = nearlight::core::read_image(argv[1]);
    std::cout << image.width << "x" << image.height << " " << image.at(2, 1, 2) << "\n";
}
