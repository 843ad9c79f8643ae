#pragma once

namespace roadbook {

// Style sheet of the report. The colours are variables with a light and a dark set. The session
// colours s0..s5 are those of Okabe and Ito, which colour-blind readers can distinguish.
inline constexpr const char* kPageStyle = R"css(
:root{--page:#fbfbf9;--card:#fff;--ink:#1d2329;--soft:#5c6670;--line:#dfe2e5;--grid:#eceeef;
--good:#1a8a4a;--bad:#d0342c;--truth:#1d2329;--bar:#4a7fb5;
--s0:#0072b2;--s1:#d55e00;--s2:#009e73;--s3:#cc79a7;--s4:#a07800;--s5:#56b4e9}
@media(prefers-color-scheme:dark){:root{--page:#14181c;--card:#1b2126;--ink:#e6e9ec;--soft:#9aa5af;
--line:#313a42;--grid:#262e35;--good:#3fc67c;--bad:#ff6b61;--truth:#e6e9ec;--bar:#6ca3da;
--s0:#4aa8e0;--s1:#ff8a3d;--s2:#2fc79b;--s3:#e39cc4;--s4:#e0b93a;--s5:#8fd0f5}}
*{box-sizing:border-box}
body{margin:0;background:var(--page);color:var(--ink);
font:15px/1.5 system-ui,-apple-system,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
main{max-width:980px;margin:0 auto;padding:28px 20px 60px}
header p{margin:0;color:var(--soft);letter-spacing:.06em;font-size:13px}
h1{margin:0 0 18px;font-size:30px;line-height:1.2;overflow-wrap:anywhere}
h2{margin:0 0 12px;font-size:18px}
h3{margin:18px 0 8px;font-size:15px}
img{max-width:100%;height:auto;background:#fff}
section{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:18px 20px;
margin:18px 0}
.tiles{display:grid;grid-template-columns:repeat(auto-fit,minmax(190px,1fr));gap:10px}
.tile{background:var(--card);border:1px solid var(--line);border-radius:8px;padding:12px 14px}
.tile b{display:block;font-size:21px;font-weight:600;line-height:1.25}
.tile span{color:var(--soft);font-size:13px}
figure{margin:0}
figcaption{color:var(--soft);font-size:13px;margin:6px 0 10px}
.pair{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(380px,100%),1fr));gap:14px}
.trio{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(230px,100%),1fr));gap:14px}
svg{display:block;width:100%;height:auto}
svg text{fill:var(--soft);font-size:12px}
.note text{fill:var(--ink);font-weight:600}
.grid{stroke:var(--grid);stroke-width:1}
.track,.truth,.accepted,.rejected,.edge,.lane,.curve{fill:none;stroke-linejoin:round;
stroke-linecap:round}
.track{stroke-width:2.2}.truth{stroke:var(--truth);stroke-width:1;stroke-dasharray:4 4}
.accepted{stroke:var(--good);stroke-width:1.4}.rejected{stroke:var(--bad);stroke-width:.7;opacity:.45}
.edge{stroke:var(--s0);stroke-width:.8;opacity:.75}.lane{stroke-width:3}
.curve{stroke:var(--bar);stroke-width:1.5}.bar{fill:var(--bar)}
.dot{fill:none;stroke-linecap:round}.met{stroke:var(--good)}.node{stroke:var(--ink)}.joint,.start{stroke:var(--ink)}
.s0{stroke:var(--s0)}.s1{stroke:var(--s1)}.s2{stroke:var(--s2)}.s3{stroke:var(--s3)}
.s4{stroke:var(--s4)}.s5{stroke:var(--s5)}
.key{white-space:nowrap;margin-right:10px}.key svg{display:inline-block;width:22px;height:8px;
margin-right:5px;vertical-align:middle}
.scroll{overflow-x:auto}
details{margin-top:8px}summary{cursor:pointer;color:var(--soft)}
table{border-collapse:collapse;font-size:14px;font-variant-numeric:tabular-nums}
th{color:var(--soft);font-weight:500;text-align:left}
th,td{padding:4px 16px 4px 0;border-bottom:1px solid var(--line);vertical-align:top;
overflow-wrap:anywhere}
.stacked th{white-space:nowrap}
.warnings{margin:0;padding-left:18px;font-size:13px}
code{font-size:.95em}
@media(max-width:640px){.stacked thead{display:none}.stacked td{display:block;border:0;padding:2px 0}
.stacked tr{display:block;border-bottom:1px solid var(--line);padding:8px 0}}
@media print{body{background:#fff}section{break-inside:avoid}}
)css";

}  // namespace roadbook
