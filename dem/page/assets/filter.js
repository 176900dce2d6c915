"use strict";
// Lists and a search above tables that ask for them by data-filter: columns by number.
for (const table of document.querySelectorAll("table[data-filter]")) {
  const rows = [...table.tBodies[0].rows], heads = table.tHead.rows[0].cells;
  const tools = document.createElement("div"), shown = document.createElement("span");
  tools.className = "tools";
  const chosen = new Map();
  let words = [];
  const update = () => {
    let count = 0;
    for (const row of rows) {
      const text = row.textContent.toLowerCase();
      const fits = [...chosen].every(([column, value]) => !value || row.cells[column].textContent === value) &&
        words.every(word => text.includes(word));
      row.hidden = !fits;
      count += fits;
    }
    shown.textContent = `${count} of ${rows.length} rows`;
  };
  for (const column of table.dataset.filter.split(" ").map(Number)) {
    const label = document.createElement("label"), list = document.createElement("select");
    label.append(heads[column].textContent + " ", list);
    list.add(new Option("all", ""));
    for (const value of [...new Set(rows.map(row => row.cells[column].textContent))].sort()) if (value) list.add(new Option(value, value));
    list.onchange = () => { chosen.set(column, list.value); update(); };
    tools.append(label);
  }
  const search = document.createElement("input");
  Object.assign(search, {type: "search", placeholder: "search", ariaLabel: "search in the table"});
  search.oninput = () => { words = search.value.toLowerCase().split(/\s+/).filter(word => word); update(); };
  tools.append(search, shown);
  table.parentElement.before(tools);
  update();
}
