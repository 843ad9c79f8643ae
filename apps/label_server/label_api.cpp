#include "apps/label_server/label_api.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <utility>

#include "apps/label_server/http/http_guard.hpp"
#include "apps/label_server/http/page_files.hpp"
#include "apps/label_server/label_wire.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kHistory = 200;  // events in the displayed history

HttpResponse json_response(const Json& json, int status = 200) {
  HttpResponse response;
  response.status = status;
  response.body = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  return response;
}

HttpResponse not_found() {
  return error_response(404,
                        "path: got an unknown path, want one listed in docs/reference/http_api.md");
}

std::vector<std::string> parts_of(const std::string& path) {
  std::vector<std::string> parts;
  std::istringstream text(path);
  for (std::string part; std::getline(text, part, '/');)
    if (!part.empty()) parts.push_back(part);
  return parts;
}

template <class Number>
Number number_of(const std::string& text) {
  Number number = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (fault != std::errc() || end != text.data() + text.size())
    throw RequestError(404, "path: got '" + text + "', want a whole number");
  return number;
}

HttpResponse text_response(std::string body, std::string type, const char* cache) {
  HttpResponse response;
  response.type = std::move(type);
  response.body = std::move(body);
  if (cache != nullptr) response.fields["Cache-Control"] = cache;
  return response;
}

// A segment of a pattern in capital letters matches any text before its suffix, for example `Y.png`
// matches `3.png`. Returns the text. Empty if the segment does not match.
std::optional<std::string> value_of(const std::string& pattern, const std::string& segment) {
  const std::string suffix = pattern.substr(std::min(pattern.find('.'), pattern.size()));
  if (!segment.ends_with(suffix)) return std::nullopt;
  return segment.substr(0, segment.size() - suffix.size());
}

// Returns the texts in place of the pattern's capital segments. Empty if the path does not match.
std::optional<std::vector<std::string>> values_in(const std::vector<std::string>& path,
                                                  const std::string& pattern) {
  const auto wanted = parts_of(pattern);
  if (wanted.size() != path.size()) return std::nullopt;
  std::vector<std::string> values;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const bool is_value = wanted[i].front() >= 'A' && wanted[i].front() <= 'Z';
    const auto value = is_value ? value_of(wanted[i], path[i]) : std::nullopt;
    if (is_value ? !value.has_value() : wanted[i] != path[i]) return std::nullopt;
    if (value) values.push_back(*value);
  }
  return values;
}

}  // namespace

LabelApi::LabelApi(const Parts& parts) : parts_(parts), map_(map_version(parts.service->map())) {}

HttpResponse LabelApi::answer(const HttpRequest& request) const {
  try {
    return route(request);
  } catch (const RequestError& fault) {
    return error_response(fault.status(), fault.what());
  } catch (const LabelConflict& fault) {
    return json_response(parts_.service->conflict(fault.current, parse_body(request.body)), 409);
  } catch (const LabelStepElsewhere& fault) {
    return error_response(412, fault.what());
  } catch (const StorageError& fault) {
    return error_response(507, std::string("the change was not stored: ") + fault.what());
  } catch (const Error& fault) {
    return error_response(422, fault.what());
  }
}

// Requests without effect. The server answers HEAD like GET.
std::vector<LabelApi::Route> LabelApi::read_routes() {
  using Api = const LabelApi&;
  return {
      {"GET", "/", [](Api, const Call&) { return page("index.html"); }},
      {"GET", "/FILE", [](Api, const Call& call) { return page(call.values[0]); }},
      {"GET", "/tiles/Z/X/Y.png", [](Api api, const Call& call) { return api.tile(call); }},
      {"GET", "/api/start", [](Api api, const Call&) { return json_response(api.start_json()); }},
      {"GET", "/api/labels",
       [](Api api, const Call&) {
         return text_response(api.parts_.service->list(), "application/json", nullptr);
       }},
      {"GET", "/api/hypotheses",
       [](Api api, const Call&) { return json_response(api.parts_.learning->hypotheses()); }},
      {"GET", "/api/progress",
       [](Api api, const Call&) { return json_response(api.parts_.learning->progress()); }},
      {"GET", "/api/history",
       [](Api api, const Call&) { return json_response(api.parts_.service->history(kHistory)); }},
      {"GET", "/api/paint",
       [](Api api, const Call&) { return json_response(api.parts_.paint->report()); }},
      {"GET", "/api/people",
       [](Api api, const Call&) { return json_response(api.parts_.people->overview()); }},
      {"GET", "/api/people/SESSION/T_NS/CAMERA",
       [](Api api, const Call& call) { return api.people(call); }},
      {"GET", "/api/image/SESSION/T_NS/CAMERA",
       [](Api api, const Call& call) { return api.image(call); }},
      {"GET", "/api/events", [](Api api, const Call&) { return api.events(); }},
  };
}

// Requests with a body. `POST /api/view` changes nothing, but needs a body.
std::vector<LabelApi::Route> LabelApi::change_routes() {
  using Api = const LabelApi&;
  const auto id_of = [](const Call& call) { return number_of<std::int64_t>(call.values[0]); };
  return {
      {"POST", "/api/labels",
       [](Api api, const Call& call) {
         return json_response(api.parts_.service->create(call.body));
       }},
      {"PUT", "/api/labels/ID",
       [id_of](Api api, const Call& call) {
         return json_response(api.parts_.service->change(id_of(call), call.body));
       }},
      {"DELETE", "/api/labels/ID",
       [id_of](Api api, const Call& call) {
         return json_response(api.parts_.service->remove(id_of(call), call.body));
       }},
      {"PUT", "/api/classes",
       [](Api api, const Call& call) {
         return json_response(api.parts_.service->set_classes(call.body));
       }},
      {"POST", "/api/undo",
       [](Api api, const Call& call) {
         return json_response(api.parts_.service->undo(call.body));
       }},
      {"POST", "/api/redo",
       [](Api api, const Call& call) {
         return json_response(api.parts_.service->redo(call.body));
       }},
      {"POST", "/api/learn", [](Api api, const Call& call) { return api.learn(call); }},
      {"POST", "/api/people/learn", [](Api api, const Call&) { return api.learn_people(); }},
      {"POST", "/api/view", [](Api api, const Call& call) { return api.view(call.body); }},
  };
}

const std::vector<LabelApi::Route>& LabelApi::routes() {
  static const std::vector<Route> all = [] {
    std::vector<Route> list = read_routes();
    for (Route& route : change_routes()) list.push_back(std::move(route));
    return list;
  }();
  return all;
}

HttpResponse LabelApi::route(const HttpRequest& request) const {
  const auto path = parts_of(request.path);
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  for (const Route& route : routes()) {
    if (route.method != method) continue;
    auto values = values_in(path, route.path);
    if (!values) continue;
    const bool has_body = method != "GET";
    const Call call{std::move(*values), has_body ? parse_body(request.body) : Json::object()};
    if (call.body.contains("map") && text_field(call.body, "map") != map_) return of_another_map();
    return route.answer(*this, call);
  }
  return not_found();
}

HttpResponse LabelApi::page(const std::string& name) {
  const auto file = page_file(name);
  return file ? text_response(std::string(file->bytes), std::string(file->type), nullptr)
              : not_found();
}

HttpResponse LabelApi::learn(const Call& call) const {
  parts_.learning->start(text_field(call.body, "kind"));
  return json_response({{"started", true}}, 202);
}

HttpResponse LabelApi::learn_people() const {
  parts_.people->start();
  return json_response({{"started", true}}, 202);
}

HttpResponse LabelApi::tile(const Call& call) const {
  const auto& values = call.values;
  const auto made = parts_.tiles->tile(number_of<int>(values[0]), number_of<int>(values[1]),
                                       number_of<int>(values[2]));
  if (!made) return not_found();
  return text_response(*made, "image/png", "private, max-age=86400, immutable");
}

HttpResponse LabelApi::people(const Call& call) const {
  const auto& values = call.values;
  return json_response(parts_.people->image(
      {number_of<int>(values[0]), number_of<std::int64_t>(values[1]), number_of<int>(values[2])}));
}

HttpResponse LabelApi::image(const Call& call) const {
  const auto& values = call.values;
  const auto bytes = parts_.views->image(
      number_of<int>(values[0]), number_of<std::int64_t>(values[1]), number_of<int>(values[2]));
  if (!bytes) return not_found();
  return text_response(*bytes, "image/jpeg", "private, max-age=3600");
}

Json LabelApi::map_json() const {
  return {{"name", parts_.place->name}, {"map", map_}, {"picture", parts_.picture}};
}

// The page was opened for an earlier map. The server now shows a different map, or the same map
// after a new build.
HttpResponse LabelApi::of_another_map() const {
  return json_response({{"error", "map: got a change made on another map, want one made on " +
                                      parts_.place->name + " as it is now"},
                        {"map", map_json()}},
                       409);
}

HttpResponse LabelApi::events() const {
  HttpResponse response;
  response.events = parts_.hub->subscribe(map_json().dump());
  if (!response.events)
    return error_response(503,
                          "pages: got too many open pages, close one and load this page again");
  return response;
}

HttpResponse LabelApi::view(const Json& body) const {
  if (!body.contains("id"))
    return json_response(parts_.views->view_of(label_from_wire(parts_.service->map(), body)));
  const auto label = parts_.service->find(integer_field(body, "id"));
  return label && is_on_ground(*label) ? json_response(parts_.views->view_of(*label)) : not_found();
}

Json LabelApi::start_json() const {
  const LabelPlace& place = *parts_.place;
  const GroundImage& image = place.image;
  Json resolutions = Json::array();
  for (int level = 0; level < parts_.tiles->levels(); ++level)
    resolutions.push_back(parts_.tiles->resolution_m(level));
  Json json = {{"name", place.name},
               {"map", map_},
               {"place", place_version(parts_.service->map())},
               {"who", parts_.who},
               {"classes", parts_.service->classes()},
               {"images", parts_.views->has_drive()},
               {"lanes", place.lanes},
               {"poses", poses_json(parts_.service->map())},
               {"picture", nullptr}};
  if (place.has_picture())
    json["picture"] = {
        {"version", parts_.picture},
        {"tile_px", TilePyramid::kTilePx},
        {"resolutions", resolutions},
        {"extent",
         {image.corner.x(), image.corner.y() - image.resolution_m * image.grey.rows,
          image.corner.x() + image.resolution_m * image.grey.cols, image.corner.y()}}};
  return json;
}

}  // namespace roadbook
