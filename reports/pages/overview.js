"use strict";
// Filter and sort of the table of all cases. Without this script it is a plain table.
(() => {
  const table = document.getElementById("all-cases"), body = table.tBodies[0];
  const rows = [...body.rows], headers = [...table.tHead.querySelectorAll("th[data-sort]")];
  const text = document.getElementById("filter-text"), verdict = document.getElementById("filter-verdict");

  function filter() {
    const words = text.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of rows) {
      const found = words.every((word) => row.dataset.text.includes(word));
      const asked = !verdict.value || row.dataset.states.split(",").includes(verdict.value);
      row.hidden = !(found && asked);
      shown += !row.hidden;
    }
    document.getElementById("filter-count").textContent = `${shown} of ${rows.length} shown`;
  }

  // Column of a header's cells: that of the header in a table whose first row spans two.
  function column(header) {
    const above = [...table.tHead.rows[0].cells];
    const before = above.filter((cell) => cell.colSpan === 1).length;
    return header.parentNode.rowIndex === 0 ? above.indexOf(header) : before + header.cellIndex;
  }

  function sort(header) {
    const falling = header.getAttribute("aria-sort") === "ascending", at = column(header);
    const key = (row) => row.cells[at].dataset.key;
    const compared = header.dataset.sort === "text"
      ? (one, other) => key(one).localeCompare(key(other))
      : (one, other) => Number(key(one)) - Number(key(other));
    // What has no number stays at the end, whichever way.
    const empty = (row) => Number(key(row) === "");
    const sorted = [...rows].sort(
      (one, other) => empty(one) - empty(other) || (falling ? compared(other, one) : compared(one, other)));
    for (const other of headers) other.setAttribute("aria-sort", "none");
    header.setAttribute("aria-sort", falling ? "descending" : "ascending");
    body.append(...sorted);
  }

  for (const header of headers) {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...header.childNodes);
    button.addEventListener("click", () => sort(header));
    header.setAttribute("aria-sort", "none");
    header.append(button);
  }
  const form = document.getElementById("filter");
  form.hidden = false;
  form.addEventListener("submit", (event) => event.preventDefault());
  text.addEventListener("input", filter);
  verdict.addEventListener("change", filter);
  filter();
})();
