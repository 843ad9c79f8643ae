#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/label_server/anchor_views.hpp"
#include "apps/label_server/http/event_hub.hpp"
#include "apps/label_server/http/http_message.hpp"
#include "apps/label_server/http/tile_pyramid.hpp"
#include "apps/label_server/label_service.hpp"
#include "apps/label_server/learning.hpp"
#include "apps/label_server/marking_check.hpp"
#include "apps/label_server/people_learning.hpp"
#include "workflows/labels/label_place.hpp"

namespace roadbook {

/// Answers the requests of the page (docs/reference/http_api.md lists the requests). Safe to use
/// from several threads.
class LabelApi {
 public:
  /// All parts must outlive the object. `who` is the initial user name of a page.
  struct Parts {
    const LabelPlace* place;
    std::string picture;  ///< version of the overhead image; the tiles of another map differ
    const TilePyramid* tiles;
    const AnchorViews* views;
    LabelService* service;
    Learning* learning;
    PeopleLearning* people;
    PaintWatch* paint;
    EventHub* hub;
    std::string who;
  };
  explicit LabelApi(const Parts& parts);

  /// Returns the answer to a request. Errors are answers {"error": text} with a status above 399.
  [[nodiscard]] HttpResponse answer(const HttpRequest& request) const;

  /// A request that matches a route.
  struct Call {
    std::vector<std::string> values;  ///< texts in place of the capital segments of the path
    nlohmann::json body;              ///< an object; empty for GET
  };
  struct Route {
    std::string method;  ///< GET also serves HEAD
    std::string path;    ///< segments in capital letters match any text: `/api/labels/ID`
    std::function<HttpResponse(const LabelApi&, const Call&)> answer;
  };
  /// Returns all routes. The first match answers a request.
  [[nodiscard]] static const std::vector<Route>& routes();

 private:
  [[nodiscard]] static std::vector<Route> read_routes();
  [[nodiscard]] static std::vector<Route> change_routes();
  [[nodiscard]] HttpResponse route(const HttpRequest& request) const;
  [[nodiscard]] static HttpResponse page(const std::string& name);
  [[nodiscard]] HttpResponse tile(const Call& call) const;
  [[nodiscard]] HttpResponse people(const Call& call) const;
  [[nodiscard]] HttpResponse image(const Call& call) const;
  [[nodiscard]] HttpResponse learn(const Call& call) const;
  [[nodiscard]] HttpResponse learn_people() const;
  [[nodiscard]] HttpResponse events() const;
  [[nodiscard]] HttpResponse view(const nlohmann::json& body) const;
  [[nodiscard]] nlohmann::json start_json() const;
  [[nodiscard]] nlohmann::json map_json() const;
  [[nodiscard]] HttpResponse of_another_map() const;

  Parts parts_;
  std::string map_;  ///< version of the map; a change may name the version on which it was made
};

}  // namespace roadbook
