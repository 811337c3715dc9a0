#include "tools/html_report.h"

namespace cellocut::tools {

// Figures of equal width, light and dark by what the reader prefers, one column where it is narrow.
const char* html_style() {
  return R"css(
:root { color-scheme: light dark;
  --page: #f7f6f3; --card: #ffffff; --ink: #1d2329; --soft: #5c6670; --line: #dcdfe2;
  --track: #eceef0; --solve: #2f6690; --build: #8fb3cc; --verify: #c9cfd4; --stage: #5a7d5a;
  --value: #c46a2b; --bound: #2f6690; --good: #2d6a3f; --bad: #b3261e; --warn: #8a5a00; }
@media (prefers-color-scheme: dark) { :root {
  --page: #14171a; --card: #1c2024; --ink: #e6e8ea; --soft: #9aa4ad; --line: #31373d;
  --track: #2a2f34; --solve: #6aa5d1; --build: #3f6a8a; --verify: #5a636b; --stage: #7fa87f;
  --value: #e08a4e; --bound: #6aa5d1; --good: #7cc492; --bad: #ff8a80; --warn: #e0b15a; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); line-height: 1.45;
  font-family: system-ui, -apple-system, "Segoe UI", "DejaVu Sans", sans-serif; font-size: 15px;
  font-variant-numeric: tabular-nums; }
main { max-width: 1160px; margin: 0 auto; padding: 28px 20px 40px; }
h1 { font-size: 1.65rem; font-weight: 650; margin: 0 0 2px; letter-spacing: -0.01em; }
h2 { font-size: 1.2rem; font-weight: 650; margin: 0 0 2px; overflow-wrap: anywhere; }
h2 small { font-weight: 400; color: var(--soft); font-size: 0.95rem; }
p { margin: 0 0 10px; }
.lead, .facts, .note { color: var(--soft); }
.facts { margin-bottom: 12px; overflow-wrap: anywhere; }
.note { font-size: 0.85rem; margin: 8px 0 0; }
.card { background: var(--card); border: 1px solid var(--line); border-radius: 8px;
  padding: 18px 20px; margin-top: 18px; }
.verdict { border-left: 4px solid var(--good); }
.verdict.bad { border-left-color: var(--bad); }
.verdict ul { margin: 6px 0 0; padding-left: 20px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: 0.88rem; }
th, td { padding: 5px 8px; text-align: right; white-space: nowrap;
  border-bottom: 1px solid var(--line); }
th { font-weight: 600; color: var(--soft); vertical-align: bottom; }
th:first-child, td:first-child, .text { text-align: left; }
td:first-child { position: sticky; left: 0; background: var(--card); font-weight: 600; }
tbody tr:last-child td { border-bottom: 0; }
td.wide { white-space: normal; overflow-wrap: anywhere; text-align: left; }
.optimal { color: var(--good); } .gap { color: var(--warn); }
.invalid { color: var(--bad); font-weight: 600; } .refused { color: var(--soft); }
.charts { display: grid; grid-template-columns: 1fr 1fr; gap: 22px 36px; margin-top: 20px; }
figure { margin: 0; min-width: 0; }
figcaption { display: flex; flex-wrap: wrap; gap: 2px 16px; justify-content: space-between;
  margin-bottom: 8px; }
.legend { color: var(--soft); font-size: 0.85rem; display: flex; flex-wrap: wrap; gap: 2px 12px; }
.legend i { display: inline-block; width: 10px; height: 10px; margin-right: 5px;
  border-radius: 2px; }
.bar { display: grid; grid-template-columns: 9.5rem minmax(0, 1fr) 6.5rem; gap: 10px;
  align-items: center; font-size: 0.85rem; padding: 2px 0; }
.bar .name { overflow: hidden; text-overflow: ellipsis; white-space: nowrap; }
.bar .number { text-align: right; white-space: nowrap; color: var(--soft); }
.track { display: flex; background: var(--track); border-radius: 2px; overflow: hidden; }
.track.apart { flex-direction: column; gap: 1px; }
.track i { display: block; height: 14px; } .track.apart i { height: 7px; }
i.solve { background: var(--solve); } i.build { background: var(--build); }
i.verify { background: var(--verify); } i.stage { background: var(--stage); }
i.value { background: var(--value); } i.bound { background: var(--bound); }
.picture img { display: block; width: 100%; max-width: 700px; height: auto; background: #ffffff;
  border-radius: 6px; }
#viewer canvas { display: block; width: 100%; height: 440px; cursor: grab; touch-action: none;
  border-radius: 6px; background: var(--track); }
#viewer canvas:active { cursor: grabbing; }
#viewer .captions { display: grid; grid-auto-flow: column; grid-auto-columns: 1fr; gap: 16px;
  margin-top: 8px; color: var(--soft); font-size: 0.85rem; }
#viewer .captions strong { color: var(--ink); }
#viewer .head { display: flex; flex-wrap: wrap; gap: 8px 16px; justify-content: space-between;
  align-items: baseline; margin-bottom: 10px; }
select { font: inherit; color: inherit; background: var(--card); border: 1px solid var(--line);
  border-radius: 5px; padding: 3px 8px; max-width: 100%; }
.columns { columns: 2; column-gap: 36px; }
.columns div { display: flex; justify-content: space-between; gap: 14px; padding: 3px 0;
  border-bottom: 1px solid var(--line); font-size: 0.88rem; break-inside: avoid; }
.columns span:first-child { color: var(--soft); }
.columns span:last-child { text-align: right; overflow-wrap: anywhere; }
details { margin-top: 18px; color: var(--soft); font-size: 0.85rem; }
details pre { white-space: pre-wrap; }
@media (max-width: 720px) {
  main { padding: 18px 10px 28px; } .card { padding: 14px 12px; }
  .charts { grid-template-columns: minmax(0, 1fr); } .columns { columns: 1; }
  .bar { grid-template-columns: 7.2rem minmax(0, 1fr) 5.2rem; gap: 8px; }
  #viewer .captions { grid-auto-flow: row; gap: 4px; } }
@media print { .card { break-inside: avoid; } #viewer { display: none; } }
)css";
}

}  // namespace cellocut::tools
