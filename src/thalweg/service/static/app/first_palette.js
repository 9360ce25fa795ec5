// Runs before the page is painted, so that a night palette never flashes white.
document.documentElement.dataset.palette = localStorage.getItem("palette") || "day";
