#pragma once

#include <string>

#include "apps/label_server/anchor_views.hpp"
#include "apps/label_server/http/event_hub.hpp"
#include "apps/label_server/http/http_message.hpp"
#include "apps/label_server/http/tile_pyramid.hpp"
#include "apps/label_server/label_place.hpp"
#include "apps/label_server/label_service.hpp"
#include "apps/label_server/learning.hpp"
#include "apps/label_server/marking_check.hpp"
#include "apps/label_server/people_learning.hpp"

namespace roadbook {

/// Answers the requests of the page (docs/guide/labelling.md lists the requests). Safe to use from
/// several threads.
class LabelApi {
 public:
  /// All parts must outlive the object. `who` is the initial user name of a page.
  struct Parts {
    const LabelPlace* place;
    std::string picture;  ///< version of the overhead image; the tiles of another map differ
    const TilePyramid* tiles;
    const AnchorViews* views;
    LabelBook* book;
    Learning* learning;
    PeopleLearning* people;
    PaintWatch* paint;
    EventHub* hub;
    std::string who;
  };
  explicit LabelApi(const Parts& parts);

  [[nodiscard]] HttpResponse answer(const HttpRequest& request) const;

 private:
  [[nodiscard]] HttpResponse route(const HttpRequest& request) const;
  [[nodiscard]] HttpResponse read(const std::vector<std::string>& path) const;
  [[nodiscard]] HttpResponse change(const HttpRequest& request,
                                    const std::vector<std::string>& path) const;
  [[nodiscard]] HttpResponse tile(const std::vector<std::string>& path) const;
  [[nodiscard]] HttpResponse people(const std::vector<std::string>& path) const;
  [[nodiscard]] HttpResponse image(const std::vector<std::string>& path) const;
  [[nodiscard]] HttpResponse events() const;
  [[nodiscard]] HttpResponse view(const nlohmann::json& body) const;
  [[nodiscard]] nlohmann::json start_json() const;
  [[nodiscard]] nlohmann::json map_json() const;
  [[nodiscard]] HttpResponse of_another_map() const;

  Parts parts_;
  std::string map_;  ///< version of the map; a change may name the version on which it was made
};

}  // namespace roadbook
