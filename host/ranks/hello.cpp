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
    const nlohmann::json json = nlohmann::json::parse(text);
    Hello hello{.host = json["host"], .facts = json["facts"], .devices = {}};
    for (const nlohmann::json& device : json["devices"]) {
        hello.devices.push_back({.number = device["number"],
                                 .name = device["name"],
                                 .batch_receivers = device["batch_receivers"]});
    }
    if (json.contains("failure")) {
        const nlohmann::json& failure = json["failure"];
        hello.failure.emplace(static_cast<ErrorKind>(failure["kind"].get<int>()),
                              failure["text"].get<std::string>());
    }
    return hello;
}

}  // namespace nearlight::core
