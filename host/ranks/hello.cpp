// SPDX-License-Identifier: Apache-2.0
#include "host/ranks/hello.h"

#include <nlohmann/json.hpp>

namespace nearlight::core {

std::string to_text(const Hello& hello) {
    nlohmann::json json{{"host", hello.host}, {"facts", hello.facts}, {"devices", nlohmann::json::array()}};
    for (const RemoteDevice& device : hello.devices) {
        json["devices"].push_back(
            {{"number", device.number}, {"name", device.name}, {"batch_receivers", device.batch_receivers}});
    }
    if (hello.failure) {
        json["failure"] = {{"kind", static_cast<int>(hello.failure->kind())},
                           {"text", hello.failure->what()}};
    }
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

Hello parse_hello(const std::string& text) {
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        Hello hello{.host = json.at("host"), .facts = json.at("facts"), .devices = {}};
        for (const nlohmann::json& device : json.at("devices")) {
            hello.devices.push_back({.number = device.at("number"),
                                     .name = device.at("name"),
                                     .batch_receivers = device.at("batch_receivers")});
        }
        if (json.contains("failure")) {
            const nlohmann::json& failure = json["failure"];
            hello.failure.emplace(static_cast<ErrorKind>(failure.at("kind").get<int>()),
                                  failure.at("text").get<std::string>());
        }
        return hello;
    } catch (const nlohmann::json::exception&) {
        return {.host = {},
                .facts = {},
                .devices = {},
                .failure = Error(ErrorKind::invalid_argument,
                                 "it is another nearlight; start the same program on all machines")};
    }
}

}  // namespace nearlight::core
