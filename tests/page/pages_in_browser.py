"""Pages of the programs, opened in headless Chromium at three widths: no script fails, every figure is drawn, nothing is
cut off at the side and no texts overlap; printed, too, and in the dark. Usage: pages_in_browser.py BIN SOURCE
Meant to catch: a missing bracket in page.js; a canvas of no height; a table wider than the page (planted: cells that are
never broken); letters of the dark on white paper; a bed that is drawn as high as on the screen and as narrow as the
paper, a long name of an axis, a page that begins with how to read it (each seen on these pages before it was mended).
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from make_pages import make

BIN, SOURCE = map(pathlib.Path, sys.argv[1:3])
BROWSER = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")

CHECK = """<script>
addEventListener('load', () => setTimeout(() => {
  const faults = [], root = document.documentElement;
  if (!root.dataset.drawn) faults.push('a script failed');
  for (const figure of document.querySelectorAll('figure')) {
    const canvas = figure.querySelector('canvas');
    if (!canvas || canvas.height < 100 || canvas.width < 100) { faults.push('not drawn: ' + figure.textContent.slice(0, 40)); continue; }
    const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
    if (!pixels.some(v => v)) faults.push('empty: ' + figure.querySelector('figcaption').textContent);
    if (figure.granrad && !/<(polyline|circle)/.test(figure.granrad.svg())) faults.push('SVG without data');
  }
  if (root.scrollWidth > root.clientWidth + 1) faults.push('wider than the window by ' + (root.scrollWidth - root.clientWidth));
  for (const table of document.querySelectorAll('.scroll'))
    if (table.scrollWidth > table.clientWidth + 1) faults.push('cut off by ' + (table.scrollWidth - table.clientWidth) + ': ' + table.textContent.trim().slice(0, 30));
  for (const canvas of document.querySelectorAll('.bed > canvas'))
    if (Math.abs(canvas.clientWidth * canvas.height / canvas.clientHeight / canvas.width - 1) > 0.02) faults.push('the bed is stretched');
  for (const figure of document.querySelectorAll('figure.chart')) {
    const chart = JSON.parse(figure.querySelector('script').textContent), brush = document.createElement('canvas').getContext('2d');
    const u = figure.granrad.plot();
    brush.font = [u.axes[1].labelFont].flat()[0];  // in pixels of the screen
    const middle = (u.bbox.top + u.bbox.height / 2) / devicePixelRatio;  // where the label is
    if (brush.measureText(chart.y_label).width / devicePixelRatio > 2 * Math.min(middle, u.height - middle)) faults.push('cut off: ' + chart.y_label);
  }
  let first = document.querySelector('h1').nextElementSibling;
  if (first.tagName === 'H2') first = first.nextElementSibling;
  if (!/verdict|tiles/.test(first.className)) faults.push('does not begin with what it came to');
  for (const cell of document.querySelectorAll('td.n'))
    if (/[a-df-zA-DF-Z*/]/.test(cell.textContent) && cell.textContent.length > 8) faults.push('no number: ' + cell.textContent);
  if (!/command|computed by/.test(document.querySelector('footer').textContent)) faults.push('says not where it comes from');
  const texts = [...document.querySelectorAll('h1, h2, p, .tile b, .tile span, figcaption, td, th, .tools > *')]
    .filter(e => e.textContent.trim()).map(e => [e, e.getBoundingClientRect()]).filter(([, r]) => r.width && r.height);
  for (let i = 0; i < texts.length; ++i)
    for (let j = i + 1; j < Math.min(texts.length, i + 60); ++j) {
      const [a, r] = texts[i], [b, s] = texts[j];
      if (a.contains(b) || b.contains(a)) continue;
      const wide = Math.min(r.right, s.right) - Math.max(r.left, s.left), high = Math.min(r.bottom, s.bottom) - Math.max(r.top, s.top);
      if (wide > 3 && high > 3) faults.push('overlap: ' + a.textContent.slice(0, 20) + ' | ' + b.textContent.slice(0, 20));
    }
  for (const table of document.querySelectorAll('table[data-filter]')) {
    const list = table.parentElement.previousElementSibling.querySelector('select'), column = +table.dataset.filter.split(' ')[0];
    list.selectedIndex = 1;
    list.onchange();
    for (const row of table.tBodies[0].rows)
      if (row.hidden === (row.cells[column].textContent === list.value)) { faults.push('filter'); break; }
  }
  root.dataset.faults = JSON.stringify(faults.slice(0, 5));
}, 300));
</script></body>"""


def faults_of(page, width, folder, dark=False, printed=False):
    checked = folder / "checked.html"
    text = page.read_text().replace("</body>", CHECK)
    if printed:  # the rules of print, on a window as wide as a page of A4 between its margins
        text = text.replace("@media print", "@media all")
    checked.write_text(text)
    theme = ["--blink-settings=preferredColorScheme=0"] if dark else []
    dom = subprocess.run([BROWSER, *theme, "--headless", "--no-sandbox", "--disable-gpu", f"--window-size={width},1200",
                          "--virtual-time-budget=8000", f"--user-data-dir={folder}/profile", "--dump-dom", checked.as_uri()],
                         capture_output=True, text=True, timeout=120).stdout
    found = re.search(r'data-faults="([^"]*)"', dom)
    return found.group(1) if found else "the browser did not answer"


def main():
    if not BROWSER:
        print("no Chromium: skipped")
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        bad = 0
        for page in make(BIN, SOURCE, folder / "pages"):
            ways = [(700, {}), (1000, {"dark": True}), (1400, {}), (718, {"printed": True})]
            for width, way in ways:
                faults = faults_of(page, width, folder, **way)
                print(f"{page.relative_to(folder)} at {width} {' '.join(way)}: {faults if faults != '[]' else 'sound'}")
                bad += faults != "[]"
    return bad != 0


sys.exit(main())
