#include "apps/label_server/label_api.hpp"

#include <charconv>
#include <sstream>

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

HttpResponse not_found() { return error_response(404, "path: got one that leads nowhere"); }

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

}  // namespace

LabelApi::LabelApi(const Parts& parts) : parts_(parts), map_(map_version(parts.book->map())) {}

HttpResponse LabelApi::answer(const HttpRequest& request) const {
  try {
    return route(request);
  } catch (const RequestError& fault) {
    return error_response(fault.status(), fault.what());
  } catch (const LabelConflict& fault) {
    return json_response(parts_.book->conflict(fault.current, parse_body(request.body)), 409);
  } catch (const LabelStepElsewhere& fault) {
    return error_response(412, fault.what());
  } catch (const StorageError& fault) {
    return error_response(507, std::string("nothing was stored: ") + fault.what());
  } catch (const Error& fault) {
    return error_response(422, fault.what());
  }
}

HttpResponse LabelApi::route(const HttpRequest& request) const {
  const auto path = parts_of(request.path);
  const bool reads = request.method == "GET" || request.method == "HEAD";
  if (path.empty() || (path.size() == 1 && path[0] != "api")) {
    const auto file = reads ? page_file(path.empty() ? "index.html" : path[0]) : std::nullopt;
    if (!file) return not_found();
    HttpResponse response;
    response.type = file->type;
    response.body = file->bytes;
    return response;
  }
  if (reads && path[0] == "tiles") return tile(path);
  if (path[0] != "api") return not_found();
  return reads ? read(path) : change(request, path);
}

HttpResponse LabelApi::read(const std::vector<std::string>& path) const {
  if (path.size() == 5 && path[1] == "image") return image(path);
  if (path.size() == 5 && path[1] == "people") return people(path);
  if (path.size() != 2) return not_found();
  const std::string& what = path[1];
  if (what == "start") return json_response(start_json());
  if (what == "hypotheses") return json_response(parts_.learning->hypotheses());
  if (what == "progress") return json_response(parts_.learning->progress());
  if (what == "people") return json_response(parts_.people->overview());
  if (what == "paint") return json_response(parts_.paint->report());
  if (what == "history") return json_response(parts_.book->history(kHistory));
  if (what == "events") return events();
  if (what != "labels") return not_found();
  HttpResponse response;
  response.body = parts_.book->list();
  return response;
}

HttpResponse LabelApi::change(const HttpRequest& request,
                              const std::vector<std::string>& path) const {
  const Json body = parse_body(request.body);
  if (body.contains("map") && text_field(body, "map") != map_) return of_another_map();
  if (path.size() == 3 && path[1] == "labels") {
    const auto id = number_of<std::int64_t>(path[2]);
    if (request.method == "PUT") return json_response(parts_.book->change(id, body));
    if (request.method == "DELETE") return json_response(parts_.book->remove(id, body));
    return not_found();
  }
  if (path.size() == 2 && path[1] == "classes" && request.method == "PUT")
    return json_response(parts_.book->set_classes(body));
  if (request.method != "POST") return not_found();
  if (path.size() == 3 && path[1] == "people" && path[2] == "learn") {
    parts_.people->start();
    return json_response({{"started", true}}, 202);
  }
  if (path.size() != 2) return not_found();
  const std::string& what = path[1];
  if (what == "labels") return json_response(parts_.book->create(body));
  if (what == "undo") return json_response(parts_.book->undo(body));
  if (what == "redo") return json_response(parts_.book->redo(body));
  if (what == "view") return view(body);
  if (what != "learn") return not_found();
  parts_.learning->start(text_field(body, "kind"));
  return json_response({{"started", true}}, 202);
}

HttpResponse LabelApi::tile(const std::vector<std::string>& path) const {
  const std::string png = ".png";
  if (path.size() != 4 || !path[3].ends_with(png)) return not_found();
  const auto made =
      parts_.tiles->tile(number_of<int>(path[1]), number_of<int>(path[2]),
                         number_of<int>(path[3].substr(0, path[3].size() - png.size())));
  if (!made) return not_found();
  HttpResponse response;
  response.type = "image/png";
  response.body = *made;
  response.fields["Cache-Control"] = "private, max-age=86400, immutable";
  return response;
}

HttpResponse LabelApi::people(const std::vector<std::string>& path) const {
  return json_response(parts_.people->image(
      {number_of<int>(path[2]), number_of<std::int64_t>(path[3]), number_of<int>(path[4])}));
}

HttpResponse LabelApi::image(const std::vector<std::string>& path) const {
  const auto bytes = parts_.views->image(number_of<int>(path[2]), number_of<std::int64_t>(path[3]),
                                         number_of<int>(path[4]));
  if (!bytes) return not_found();
  HttpResponse response;
  response.type = "image/jpeg";
  response.body = *bytes;
  response.fields["Cache-Control"] = "private, max-age=3600";
  return response;
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
  if (!response.events) return error_response(503, "pages: got too many open ones, want fewer");
  return response;
}

HttpResponse LabelApi::view(const Json& body) const {
  if (!body.contains("id"))
    return json_response(parts_.views->view_of(label_from_wire(parts_.book->map(), body)));
  const auto label = parts_.book->find(integer_field(body, "id"));
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
               {"place", place_version(parts_.book->map())},
               {"who", parts_.who},
               {"classes", parts_.book->classes()},
               {"images", parts_.views->has_drive()},
               {"lanes", place.lanes},
               {"poses", poses_json(parts_.book->map())},
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
