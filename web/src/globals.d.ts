/** Whether the horse was there when the page was built (vite.config.js). */
declare const HAS_HORSE: boolean;
