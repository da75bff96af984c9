// What the page calls the numbers that files know by other names.

const WORDS = { posterior: "probability", "sigma common": "sigma of calibration" };

export const wordFor = (name) => WORDS[name] ?? name;
