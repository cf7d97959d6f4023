// The landing sites that gravity is asked for.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tasks/gravity/gravity_body.h"
#include "tasks/gravity/gravity_table.h"
#include "tasks/gravity/landing_sites.h"
#include "tasks/job/job.h"

namespace astrolith {

struct SitesRequest {
  int count = 0;               // 0: none
  double side = 0.0;           // body's unit
  double distance = 0.0;       // body's unit; 0: two sides
  std::filesystem::path list;  // .csv; empty = none
};

void declare_sites_options(OptionTable& app, SitesRequest& request);

// Throws InputError for options that lack one another, for a list that cannot be written, and for sites where
// the places are not facets.
void check_sites(const Job& job, const SitesRequest& request, bool of_facets);

// Finds the sites by the slopes among the columns, says them, writes the list, and adds them to the figures.
// `shape` is the body's file. Returns none where none are asked for.
std::vector<LandingSite> landing_sites(Job& job, const SitesRequest& request, const std::string& shape,
                                       const GravityBody& body, const std::vector<GravityColumn>& columns,
                                       nlohmann::ordered_json& figures);

}  // namespace astrolith
