#include "panel.hpp"

#include "charts.hpp"

#include <imgui.h>

#include <sstream>

namespace live {

namespace {

const ImVec4 quiet{0.62F, 0.66F, 0.71F, 1.0F}, warning{0.97F, 0.55F, 0.45F, 1.0F};

bool slider(const char* name, double& value, double low, double high, const char* format) {
  ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &low, &high, format, ImGuiSliderFlags_AlwaysClamp);
  return ImGui::IsItemDeactivatedAfterEdit();  // once, when it is let go: a session begins again
}

bool same_line_button(const char* label, bool on) {
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
  const bool clicked = ImGui::Button(label);
  if (on) ImGui::PopStyleColor();
  ImGui::SameLine();
  return clicked;
}

void choose_scene(Stage& stage, PanelWishes& wishes) {
  for (const std::string& name : scene_names())
    if (same_line_button(name.c_str(), name == stage.scene().name)) wishes.scene = name;
  ImGui::NewLine();
  ImGui::PushStyleColor(ImGuiCol_Text, quiet);
  ImGui::TextWrapped("%s", stage.scene().text.c_str());
  ImGui::PopStyleColor();
}

void show_forces(Stage& stage, float width) {
  const TickLog& log = stage.log(stage.hand().active());
  const RecordedTick& tick = log.newest().tick;
  const double force = tick.force.norm();
  if (std::isfinite(tick.error_bound) && force > 0.0)
    ImGui::Text("Force %.3f N  +- %.3f N", force, tick.error_bound);
  else
    ImGui::Text("Force %.3f N", force);
  draw_force_chart(log, width, 108.0F);
  draw_tick_histogram(log, 1e-3, width, 84.0F);
}

void choose_composition(Stage& stage, PanelState& state, PanelWishes& wishes) {
  if (!ImGui::BeginTable("compositions", 5, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
  for (const char* title : {"switch while you touch", "force", "+-", "tick p99", "set-up"})
    ImGui::TableSetupColumn(title);
  ImGui::TableHeadersRow();
  for (const Composition c : stage.scene().compositions) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (ImGui::RadioButton(name_of(c), state.composition == c) && !state.building) wishes.composition = c;
    const auto tried = state.trials.find(c);
    if (tried == state.trials.end()) continue;
    const Trial& t = tried->second;
    ImGui::TableNextColumn();
    if (t.force > 0.0) ImGui::Text("%.3f N", t.force);
    ImGui::TableNextColumn();
    if (t.force > 0.0 && std::isfinite(t.bound)) ImGui::Text("%.0f %%", 100.0 * t.bound / t.force);
    ImGui::TableNextColumn();
    ImGui::Text("%.0f us", 1e6 * t.p99);
    ImGui::TableNextColumn();
    ImGui::Text("%.2f s", t.set_up);
  }
  ImGui::EndTable();
  if (state.building) ImGui::TextColored(quiet, "preparing the organ ...");
}

void tune(Stage& stage, PanelState& state, PanelWishes& wishes) {
  Tuning& t = state.tuning;
  wishes.rebuild |= slider("stiffness", t.stiffness, 0.2, 5.0, "x %.2f");
  wishes.retune |= slider("friction", t.friction, 0.0, 1.0, "%.2f");
  wishes.retune |= slider("coupling", t.coupling, 50.0, 500.0, "%.0f N/m");
  wishes.retune |= slider("tool radius", t.radius, 0.5, 2.0, "x %.2f");
  static double angle = 0.0, size = 0.0;
  const bool changed = slider("gravity", size, 0.0, 9.81, "%.2f m/s2"),
             tilted = slider("its tilt", angle, -180.0, 180.0, "%.0f deg");
  if (changed || tilted) {
    const double radians = angle * 3.14159265358979 / 180.0;
    t.gravity = size * Vector3(std::sin(radians), 0.0, -std::cos(radians));
    wishes.retune = true;
  }
  int field = stage.field == Field::von_mises ? 1 : 0;
  ImGui::RadioButton("displacement", &field, 0);
  if (stage.organ() != nullptr && stage.organ()->has(Field::von_mises)) {
    ImGui::SameLine();
    ImGui::RadioButton("von Mises stress", &field, 1);
  }
  stage.field = field == 1 ? Field::von_mises : Field::displacement;
}

void act(Stage& stage, PanelState& state, PanelWishes& wishes) {
  const auto button = [&](const char* label, char key, bool on) {
    if (same_line_button(label, on)) wishes.keys += key;
  };
  button(stage.log().recording() ? "R stop" : "R record", 'R', stage.log().recording());
  button("P picture", 'P', false);
  button("V VTU", 'V', false);
  if (!stage.scene().hidden_region.empty()) button("L reveal", 'L', state.picture.reveal);
  ImGui::NewLine();
  button("H hold still", 'H', stage.hand().keeps_still());
  button("G grasp", 'G', stage.hand().grasps());
  if (stage.tools().size() > 1) button("Tab other tool", '\t', false);
  button("U unplug", 'U', stage.hand().unplugged());
  ImGui::NewLine();
  if (!state.news.empty()) ImGui::TextColored(quiet, "%s", state.news.c_str());
}

}  // namespace

PanelWishes draw_panel(Stage& stage, PanelState& state, int window_width, int window_height) {
  PanelWishes wishes;
  ImGui::SetNextWindowPos({static_cast<float>(window_width - panel_width), 0.0F});
  ImGui::SetNextWindowSize({static_cast<float>(panel_width), static_cast<float>(window_height)});
  ImGui::Begin("palpate", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings);
  const float width = ImGui::GetContentRegionAvail().x;
  choose_scene(stage, wishes);
  if (!state.refused.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, warning);
    ImGui::TextWrapped("Refused: %s", state.refused.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::Separator();
  show_forces(stage, width);
  choose_composition(stage, state, wishes);
  ImGui::Separator();
  act(stage, state, wishes);
  ImGui::PushItemWidth(0.66F * width);
  if (ImGui::CollapsingHeader("Tune", ImGuiTreeNodeFlags_DefaultOpen)) tune(stage, state, wishes);
  ImGui::PopItemWidth();
  if (ImGui::CollapsingHeader("Status of the ticks", ImGuiTreeNodeFlags_DefaultOpen))
    draw_status(stage.log(stage.hand().active()).recent(), width);
  if (stage.organ() != nullptr && ImGui::CollapsingHeader("Set-up report")) {
    std::ostringstream words;
    words << stage.organ()->report();
    ImGui::TextWrapped("%s", words.str().c_str());
  }
  ImGui::TextColored(quiet, "%.0f frames/s", state.frames_per_second);
  ImGui::End();
  return wishes;
}

}  // namespace live
